// Every entry of the input file: section, name, default, allowed values, unit, meaning.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

// Only the name: whoever reads parameters need not compile deal.II's parameter headers.
namespace dealii::Patterns
{
class PatternBase;
}

namespace ddfem::coupling
{
/// One entry of the input file.
struct ParameterEntry
{
  std::string section; ///< empty at top level
  std::string name;
  std::string default_value;
  std::shared_ptr<const dealii::Patterns::PatternBase> pattern;
  std::string unit; ///< empty for numbers without dimension and for words
  std::string documentation;

  /// "Section/Name", or "Name" at top level.
  std::string path() const { return section.empty() ? name : section + "/" + name; }
};

/// All entries, in the order in which they are printed.
const std::vector<ParameterEntry> &parameter_table();

/// Values read from an input file (.prm or .json) and from the command line, checked entry by entry against the table.
class InputDeck
{
public:
  /// Defaults only.
  InputDeck();
  /// Reads @p file. Throws InputError if it cannot be opened, for an unknown section or entry (with a suggestion), and for a
  /// value out of range.
  void read(const std::string &file);
  /// "Section/Entry=value" from the command line.
  void set_from_command_line(const std::string &assignment);

  std::string text(const std::string &path) const;
  double number(const std::string &path) const;
  unsigned integer(const std::string &path) const;
  bool flag(const std::string &path) const;
  /// Numbers separated by blanks or commas; exactly @p n of them (any number for n = 0), else InputError.
  std::vector<double> numbers(const std::string &path, std::size_t n = 0) const;
  /// Items separated by ';' (blank ones dropped).
  std::vector<std::string> items(const std::string &path) const;

  /// True if the input sets the entry.
  bool is_set(const std::string &path) const { return origin.count(path) > 0; }
  /// InputError whose message names the place and value of an entry: "file:line: Section/Entry = value: @p complaint".
  [[noreturn]] void reject(const std::string &path, const std::string &complaint) const;
  /// Directory that relative file names in the input refer to.
  const std::string &directory() const { return input_directory; }

  /// The resolved input as .prm text.
  std::string as_prm() const;
  std::string as_json() const;

private:
  void set(const std::string &path, const std::string &value, const std::string &where);
  void read_prm(const std::string &file);
  void read_json(const std::string &file);

  std::map<std::string, std::string> values;
  std::map<std::string, std::string> origin; ///< "file:line" or "--set", by path
  std::string input_directory = ".";
};

/// The parameter reference as Markdown.
std::string parameters_as_markdown();

/// Best match of @p word among @p candidates by edit distance, or empty if none is near.
std::string closest_match(const std::string &word, const std::vector<std::string> &candidates);
} // namespace ddfem::coupling
