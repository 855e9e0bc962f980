#include "dd/io/paradis_file.h"

#include "dd/io/file_error.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

namespace ddfem::paradis
{
namespace
{
struct Token
{
  std::string text;
  std::size_t line = 0;
};

/// Words, numbers and the characters = [ ]; commas separate, # starts a comment.
std::vector<Token> tokens_of(const std::filesystem::path &path)
{
  std::ifstream in(path);
  if (!in)
    throw FileError(path.string() + ": the file cannot be opened for reading.");
  std::vector<Token> tokens;
  std::string text;
  for (std::size_t line = 1; std::getline(in, text); ++line)
  {
    std::string word;
    const auto flush = [&]()
    {
      if (!word.empty())
        tokens.push_back({std::move(word), line});
      word.clear();
    };
    for (const char c : text.substr(0, text.find('#')))
    {
      const bool is_symbol = c == '=' || c == '[' || c == ']';
      if (is_symbol || c == ',' || std::isspace(static_cast<unsigned char>(c)) != 0)
        flush();
      if (is_symbol)
        tokens.push_back({std::string(1, c), line});
      else if (c != ',' && std::isspace(static_cast<unsigned char>(c)) == 0)
        word += c;
    }
    flush();
  }
  if (in.bad())
    throw FileError(path.string() + ": reading failed.");
  return tokens;
}

class Parser
{
public:
  explicit Parser(const std::filesystem::path &path) : tokens_(tokens_of(path)) { file_.path = path; }

  File parse()
  {
    parse_header();
    parse_nodes();
    return std::move(file_);
  }

private:
  [[noreturn]] void fail(std::size_t line, const std::string &message) const
  {
    throw FileError(at_line(file_.path, line, message));
  }
  std::size_t last_line() const { return tokens_.empty() ? 1 : tokens_.back().line; }

  const Token &take(const std::string &what)
  {
    if (next_ >= tokens_.size())
      fail(last_line(), "the file ends where " + what + " is expected; it is truncated.");
    return tokens_[next_++];
  }

  template <class Number> Number number(const std::string &what, const char *allowed)
  {
    const Token &token = take(what);
    const char *begin = token.text.data(), *const end = begin + token.text.size();
    if (*begin == '+') // from_chars does not take it
      ++begin;
    Number value{};
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end)
      fail(token.line, what + " is \"" + token.text + "\"; it must be " + allowed + ".");
    return value;
  }
  int integer(const std::string &what) { return number<int>(what, "an integer of at most 32 bits"); }
  double real(const std::string &what)
  {
    const double value = number<double>(what, "a number");
    if (!std::isfinite(value))
      fail(tokens_[next_ - 1].line, what + " is " + tokens_[next_ - 1].text + "; it must be finite.");
    return value;
  }
  Vec3 vector(const std::string &what)
  {
    const double x = real(what + " x"), y = real(what + " y");
    return {x, y, real(what + " z")};
  }
  Tag tag(const std::string &what)
  {
    const int domain = integer(what + " (domain)");
    return {domain, integer(what + " (index)")};
  }

  void expect(const char *symbol, const std::string &what)
  {
    const Token &token = take(std::string("\"") + symbol + "\" of " + what);
    if (token.text != symbol)
      fail(token.line, "\"" + token.text + "\" where \"" + symbol + "\" of " + what + " is expected.");
  }
  Vec3 bracketed_vector(const std::string &name)
  {
    expect("[", name);
    Vec3 value = vector(name);
    expect("]", name);
    return value;
  }

  void parse_header();
  void parse_entry(const Token &name);
  void parse_nodes();
  void parse_node();
  void skip_value();
  template <class T> void require(const std::optional<T> &value, const char *name) const
  {
    if (!value)
      fail(tokens_[next_ - 1].line, std::string("the header lacks the entry \"") + name + "\".");
  }

  File file_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  std::optional<int> version_, n_segments_, n_nodes_;
  std::optional<Vec3> lower_, upper_;
};

void Parser::skip_value()
{
  // Up to the next "name =".
  while (next_ < tokens_.size() && !(next_ + 1 < tokens_.size() && tokens_[next_ + 1].text == "="))
    ++next_;
}

void Parser::parse_entry(const Token &name)
{
  if (name.text == "dataFileVersion")
  {
    version_ = integer(name.text);
    if (*version_ != 4 && *version_ != 5)
      fail(name.line, "dataFileVersion is " + std::to_string(*version_) + "; versions 4 and 5 are understood.");
  }
  else if (name.text == "numFileSegments")
  {
    n_segments_ = integer(name.text);
    if (*n_segments_ != 1)
      fail(name.line,
           "numFileSegments is " + std::to_string(*n_segments_) + "; only files in one piece (1) are understood.");
  }
  else if (name.text == "nodeCount")
  {
    n_nodes_ = integer(name.text);
    if (*n_nodes_ < 0)
      fail(name.line, "nodeCount is " + std::to_string(*n_nodes_) + "; it must not be negative.");
  }
  else if (name.text == "minCoordinates")
    lower_ = bracketed_vector(name.text);
  else if (name.text == "maxCoordinates")
    upper_ = bracketed_vector(name.text);
  else
    skip_value();
}

void Parser::parse_header()
{
  while (true)
  {
    const Token name = take("the entry \"nodalData\"");
    expect("=", "an entry of the header after \"" + name.text + "\"");
    if (name.text == "nodalData")
      break;
    parse_entry(name);
  }
  require(version_, "dataFileVersion");
  require(lower_, "minCoordinates");
  require(upper_, "maxCoordinates");
  require(n_nodes_, "nodeCount");
  if (!((*upper_ - *lower_).minCoeff() > 0))
    fail(tokens_[next_ - 1].line, "maxCoordinates must exceed minCoordinates in every component.");
  file_.lower = *lower_;
  file_.upper = *upper_;
}

void Parser::parse_node()
{
  const std::string what = "node " + std::to_string(file_.nodes.size() + 1) + " of " + std::to_string(*n_nodes_);
  FileNode node;
  node.tag = tag("the tag of " + what);
  node.line = tokens_[next_ - 1].line;
  node.position = vector("the position of " + what);
  const int n_arms = integer("the number of arms of " + what);
  if (n_arms < 0 || n_arms > 1000)
    fail(node.line, "the number of arms of node " + to_string(node.tag) + " is " + std::to_string(n_arms) +
                        "; it must be between 0 and 1000.");
  node.constraint = integer("the constraint of " + what);
  for (int k = 0; k < n_arms; ++k)
  {
    const std::string arm_name = "arm " + std::to_string(k + 1) + " of node " + to_string(node.tag);
    Arm arm;
    arm.tag = tag("the tag of " + arm_name);
    arm.line = tokens_[next_ - 1].line;
    arm.burgers = vector("the Burgers vector of " + arm_name);
    arm.normal = vector("the normal of " + arm_name);
    node.arms.push_back(arm);
  }
  if (!file_.node_of_tag.try_emplace(node.tag, file_.nodes.size()).second)
    fail(node.line, "node " + to_string(node.tag) + " is given a second time; tags must be unique.");
  file_.nodes.push_back(std::move(node));
}

void Parser::parse_nodes()
{
  for (int k = 0; k < *n_nodes_; ++k)
    parse_node();
  if (next_ != tokens_.size())
    fail(tokens_[next_].line, "\"" + tokens_[next_].text + "\" follows the last of the " + std::to_string(*n_nodes_) +
                                  " nodes that nodeCount promises; nothing may follow.");
}
} // namespace

std::string to_string(const Tag &tag)
{
  return std::to_string(tag.first) + "," + std::to_string(tag.second);
}

std::string at_line(const std::filesystem::path &path, std::size_t line, const std::string &message)
{
  return path.string() + ":" + std::to_string(line) + ": " + message;
}

File parse(const std::filesystem::path &path)
{
  return Parser(path).parse();
}
} // namespace ddfem::paradis
