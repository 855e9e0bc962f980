// Reads history.csv back.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace ddfem::test
{
/// Values of the columns by their names, unit included.
using Columns = std::map<std::string, std::vector<double>>;

inline Columns read_history(const std::string &file)
{
  std::ifstream in(file);
  std::string line, cell;
  std::getline(in, line);
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, cell, ',');)
    names.push_back(cell);
  Columns columns;
  while (std::getline(in, line))
  {
    std::istringstream row(line);
    for (const std::string &name : names)
    {
      std::getline(row, cell, ',');
      columns[name].push_back(std::stod(cell));
    }
  }
  return columns;
}
} // namespace ddfem::test
