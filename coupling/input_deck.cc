#include "coupling/input_error.h"
#include "coupling/parameter_table.h"

#include <boost/property_tree/json_parser.hpp>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>

namespace ddfem::coupling
{
namespace
{
std::string trim(const std::string &s)
{
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string::npos)
    return "";
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

/// @p s with commas and runs of blanks replaced by single blanks.
std::string single_blanks(std::string s)
{
  std::replace(s.begin(), s.end(), ',', ' ');
  std::istringstream in(s);
  std::string result;
  for (std::string word; in >> word;)
    result += (result.empty() ? "" : " ") + word;
  return result;
}

std::size_t edit_distance(const std::string &a, const std::string &b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const bool same =
          std::tolower(static_cast<unsigned char>(a[i - 1])) == std::tolower(static_cast<unsigned char>(b[j - 1]));
      const std::size_t next = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (same ? 0 : 1)});
      diagonal = row[j];
      row[j] = next;
    }
  }
  return row[b.size()];
}

const ParameterEntry *find_entry(const std::string &path)
{
  for (const ParameterEntry &e : parameter_table())
    if (e.path() == path)
      return &e;
  return nullptr;
}

/// What an entry allows, in words.
std::string allowed_values(const ParameterEntry &e)
{
  std::string text = e.pattern->description(dealii::Patterns::PatternBase::Text);
  const std::vector<std::pair<std::string, std::string>> plain_words{
      {"A floating point number v such that 2.22507e-308 <= v <= MAX_DOUBLE", "a positive number"},
      {"A floating point number v such that 0 <= v <= MAX_DOUBLE", "a number not below zero"},
      {"A floating point number v such that -MAX_DOUBLE <= v <= MAX_DOUBLE", "a number"},
      {"A floating point number v such that", "a number v with"},
      {"An integer n such that", "an integer n with"},
      {"<= n <= 2147483647", "<= n"},
      {"A list of 3 to 3 elements separated by < > where each element is ", "three of "},
      {"A list of 3 to 4 elements separated by < > where each element is ", "three or four of "},
      {"A list of 6 to 6 elements separated by < > where each element is ", "six of "},
      {"Any one of", "one of"},
      {"A boolean value (true or false)", "true or false"},
      {"Any string", "text"}};
  for (const auto &[from, to] : plain_words)
    if (const auto at = text.find(from); at != std::string::npos)
      text.replace(at, from.size(), to);
  return text;
}

std::string unit_suffix(const ParameterEntry &e)
{
  return e.unit.empty() ? "" : ", in " + e.unit;
}

std::string unknown_entry_message(const std::string &path)
{
  const auto slash = path.rfind('/');
  const std::string section = slash == std::string::npos ? "" : path.substr(0, slash);
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  std::vector<std::string> in_section, sections, elsewhere;
  for (const ParameterEntry &e : parameter_table())
  {
    if (e.section == section)
      in_section.push_back(e.name);
    if (e.name == name)
      elsewhere.push_back(e.section);
    if (std::find(sections.begin(), sections.end(), e.section) == sections.end())
      sections.push_back(e.section);
  }
  std::string message;
  if (in_section.empty())
  {
    message = "there is no section '" + section + "'";
    const std::string near = closest_match(section, sections);
    if (!near.empty())
      message += "; did you mean '" + near + "'?";
    return message;
  }
  message = "there is no entry '" + name + "'" + (section.empty() ? " at top level" : " in section '" + section + "'");
  const std::string near = closest_match(name, in_section);
  if (!near.empty())
    message += "; did you mean '" + near + "'?";
  else if (!elsewhere.empty())
    message += elsewhere[0].empty() ? "; it belongs at top level" : "; it belongs in section '" + elsewhere[0] + "'";
  else
    message +=
        "; known are: " + std::accumulate(std::next(in_section.begin()), in_section.end(), in_section[0],
                                          [](const std::string &a, const std::string &b) { return a + ", " + b; });
  return message;
}

/// A handler with all entries declared.
void declare(dealii::ParameterHandler &prm)
{
  for (const ParameterEntry &e : parameter_table())
  {
    if (!e.section.empty())
      prm.enter_subsection(e.section);
    prm.declare_entry(e.name, e.default_value, *e.pattern,
                      e.documentation + (e.unit.empty() ? "" : " Unit: " + e.unit + "."));
    if (!e.section.empty())
      prm.leave_subsection();
  }
}

} // namespace

std::string closest_match(const std::string &word, const std::vector<std::string> &candidates)
{
  std::string best;
  std::size_t distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string &c : candidates)
    if (const std::size_t d = edit_distance(word, c); d < distance)
    {
      distance = d;
      best = c;
    }
  return best;
}

InputDeck::InputDeck()
{
  for (const ParameterEntry &e : parameter_table())
    values[e.path()] = e.default_value;
}

void InputDeck::set(const std::string &path, const std::string &given, const std::string &where)
{
  const ParameterEntry *entry = find_entry(path);
  if (!entry)
    throw InputError(where + ": " + unknown_entry_message(path));
  // Lists of numbers are separated by single blanks for deal.II, by any blanks or commas for people.
  const bool is_list = dynamic_cast<const dealii::Patterns::List *>(entry->pattern.get()) != nullptr;
  const std::string value = is_list ? single_blanks(given) : given;
  if (!entry->pattern->match(value))
    throw InputError(where + ": " + path + " = " + (value.empty() ? "(empty)" : value) + ": allowed is " +
                     allowed_values(*entry) + unit_suffix(*entry));
  values[path] = value;
  origin[path] = where;
}

void InputDeck::read(const std::string &file)
{
  if (!std::ifstream(file) || std::filesystem::is_directory(file))
    throw InputError(file + ": cannot be opened for reading");
  input_directory = std::filesystem::absolute(file).parent_path().string();
  if (std::filesystem::path(file).extension() == ".json")
    read_json(file);
  else
    read_prm(file);
}

void InputDeck::read_prm(const std::string &file)
{
  std::ifstream in(file);
  std::vector<std::string> sections;
  std::string line;
  for (unsigned number = 1; std::getline(in, line); ++number)
  {
    const std::string where = file + ":" + std::to_string(number);
    line = trim(line.substr(0, line.find('#')));
    std::replace(line.begin(), line.end(), '\t', ' ');
    while (!line.empty() && line.back() == '\\')
    {
      std::string next;
      if (!std::getline(in, next))
        throw InputError(where + ": the file ends after a continuation mark '\\'");
      ++number;
      line = trim(trim(line.substr(0, line.size() - 1)) + " " + trim(next.substr(0, next.find('#'))));
    }
    if (line.empty())
      continue;
    if (line == "end")
    {
      if (sections.empty())
        throw InputError(where + ": 'end' without a 'subsection'");
      sections.pop_back();
    }
    else if (line.rfind("subsection ", 0) == 0)
      sections.push_back(trim(line.substr(11)));
    else if (const auto equals = line.find('='); line.rfind("set ", 0) == 0 && equals != std::string::npos)
    {
      std::string path;
      for (const std::string &s : sections)
        path += s + "/";
      set(path + trim(line.substr(4, equals - 4)), trim(line.substr(equals + 1)), where);
    }
    else
      throw InputError(where + ": '" + line +
                       "' is neither 'subsection NAME', 'set NAME = VALUE', 'end' nor a comment");
  }
  if (!sections.empty())
    throw InputError(file + ": the file ends inside subsection '" + sections.back() + "': an 'end' is missing");
}

void InputDeck::read_json(const std::string &file)
{
  boost::property_tree::ptree tree;
  try
  {
    boost::property_tree::read_json(file, tree);
  }
  catch (const boost::property_tree::json_parser_error &e)
  {
    throw InputError(file + ":" + std::to_string(e.line()) + ": not valid JSON: " + e.message());
  }
  const std::function<void(const boost::property_tree::ptree &, const std::string &)> visit =
      [&](const boost::property_tree::ptree &node, const std::string &path)
  {
    for (const auto &[name, child] : node)
    {
      const std::string child_path = path.empty() ? name : path + "/" + name;
      if (child.empty())
        set(child_path, trim(child.data()), file);
      else
        visit(child, child_path);
    }
  };
  visit(tree, "");
}

void InputDeck::set_from_command_line(const std::string &assignment)
{
  const auto equals = assignment.find('=');
  if (equals == std::string::npos)
    throw InputError("--set " + assignment + ": allowed is \"Section/Entry=value\"");
  set(trim(assignment.substr(0, equals)), trim(assignment.substr(equals + 1)), "--set");
}

std::string InputDeck::text(const std::string &path) const
{
  return values.at(path);
}

double InputDeck::number(const std::string &path) const
{
  return std::stod(values.at(path));
}

unsigned InputDeck::integer(const std::string &path) const
{
  return static_cast<unsigned>(std::stoul(values.at(path)));
}

bool InputDeck::flag(const std::string &path) const
{
  const std::string v = values.at(path);
  return v == "true" || v == "yes" || v == "on";
}

std::vector<double> InputDeck::numbers(const std::string &path, const std::size_t n) const
{
  std::string s = values.at(path);
  std::replace(s.begin(), s.end(), ',', ' ');
  std::istringstream in(s);
  std::vector<double> result;
  for (double x = 0; in >> x;)
    result.push_back(x);
  if (!in.eof() || (n > 0 && result.size() != n))
    reject(path, "allowed are " + (n > 0 ? std::to_string(n) + " " : "") + "numbers separated by blanks");
  return result;
}

std::vector<std::string> InputDeck::items(const std::string &path) const
{
  std::istringstream in(values.at(path));
  std::vector<std::string> result;
  for (std::string item; std::getline(in, item, ';');)
    if (!trim(item).empty())
      result.push_back(trim(item));
  return result;
}

void InputDeck::reject(const std::string &path, const std::string &complaint) const
{
  const auto where = origin.find(path);
  const std::string value = values.at(path).empty() ? "(empty)" : values.at(path);
  throw InputError((where == origin.end() ? "default value" : where->second) + ": " + path + " = " + value + ": " +
                   complaint);
}

std::string InputDeck::as_prm() const
{
  dealii::ParameterHandler prm;
  declare(prm);
  for (const ParameterEntry &e : parameter_table())
  {
    if (!e.section.empty())
      prm.enter_subsection(e.section);
    prm.set(e.name, values.at(e.path()));
    if (!e.section.empty())
      prm.leave_subsection();
  }
  std::ostringstream out;
  prm.print_parameters(out, dealii::ParameterHandler::Text);
  return out.str();
}

std::string InputDeck::as_json() const
{
  boost::property_tree::ptree tree;
  for (const ParameterEntry &e : parameter_table())
    tree.put(boost::property_tree::ptree::path_type(e.path(), '/'), values.at(e.path()));
  std::ostringstream out;
  boost::property_tree::write_json(out, tree);
  return out.str();
}

std::string parameters_as_markdown()
{
  std::ostringstream out;
  out << "# Input parameters\n\nMade by `ddfem parameters --format md`. All quantities in SI units.\n";
  std::string section = "(none)";
  for (const ParameterEntry &e : parameter_table())
  {
    if (e.section != section)
    {
      section = e.section;
      out << "\n## " << (section.empty() ? "Top level" : section) << "\n\n"
          << "| Entry | Default | Allowed | Unit | Meaning |\n|---|---|---|---|---|\n";
    }
    std::string allowed = allowed_values(e);
    for (std::size_t p = 0; (p = allowed.find('|', p)) != std::string::npos; p += 2)
      allowed.insert(p, "\\");
    std::replace(allowed.begin(), allowed.end(), '\n', ' ');
    out << "| " << e.name << " | " << (e.default_value.empty() ? "(empty)" : "`" + e.default_value + "`") << " | "
        << allowed << " | " << (e.unit.empty() ? "-" : e.unit) << " | " << e.documentation << " |\n";
  }
  return out.str();
}
} // namespace ddfem::coupling
