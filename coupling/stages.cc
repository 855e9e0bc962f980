#include "coupling/stages.h"

#include "dd/common/units.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace ddfem::coupling
{
namespace
{
constexpr const char *form =
    "allowed is 'KIND [NUMBER] until END NUMBER' with KIND one of strain rate, stress rate, constant "
    "stress, free, hold, unload and END one of duration, strain, stress, plastic strain";

/// Words of one half of an item, and the number behind them.
struct Phrase
{
  std::string words;
  std::optional<double> number;
};

Phrase read_phrase(const std::string &text, const std::string &item)
{
  std::istringstream in(text);
  Phrase phrase;
  for (std::string word; in >> word;)
  {
    if (phrase.number)
      throw std::invalid_argument("'" + item + "': nothing may follow the number in '" + text + "'; " + form);
    std::size_t used = 0;
    double number = 0;
    try
    {
      number = std::stod(word, &used);
    }
    catch (const std::exception &)
    {
      used = 0;
    }
    if (used == word.size() && std::isfinite(number))
      phrase.number = number;
    else
      phrase.words += (phrase.words.empty() ? "" : " ") + word;
  }
  return phrase;
}

Stage stage_of_kind(const Phrase &p, const std::string &item)
{
  Stage stage;
  const auto needs_number = [&](const StageKind kind, const double unit)
  {
    if (!p.number)
      throw std::invalid_argument("'" + item + "': '" + p.words + "' needs a rate");
    stage.kind = kind;
    stage.rate = *p.number * unit;
  };
  if (p.words == "strain rate")
    needs_number(StageKind::strain_rate, units::per_second);
  else if (p.words == "stress rate")
    needs_number(StageKind::stress_rate, units::pascal / units::second);
  else if (p.words == "unload")
    needs_number(StageKind::unload, units::per_second);
  else if (p.words == "constant stress")
    stage = {.kind = StageKind::constant_stress,
             .jumps = p.number.has_value(),
             .stress = p.number.value_or(0) * units::pascal};
  else if ((p.words == "free" || p.words == "hold") && p.number)
    throw std::invalid_argument("'" + item + "': '" + p.words + "' takes no number");
  else if (p.words == "free")
    stage = {.kind = StageKind::constant_stress, .jumps = true};
  else if (p.words != "hold")
    throw std::invalid_argument("'" + item + "': there is no kind '" + p.words + "'; " + form);
  if (stage.kind == StageKind::unload && stage.rate <= 0)
    throw std::invalid_argument("'" + item + "': the rate of unloading is a magnitude and must be positive");
  return stage;
}

void add_end(Stage &stage, const Phrase &p, const std::string &item)
{
  if (!p.number)
    throw std::invalid_argument("'" + item + "': the end needs a number; " + form);
  if (p.words == "duration")
    stage.end = StageEnd::duration, stage.end_value = *p.number * units::second;
  else if (p.words == "strain")
    stage.end = StageEnd::strain, stage.end_value = *p.number;
  else if (p.words == "stress")
    stage.end = StageEnd::stress, stage.end_value = *p.number * units::pascal;
  else if (p.words == "plastic strain")
    stage.end = StageEnd::plastic_strain, stage.end_value = *p.number;
  else
    throw std::invalid_argument("'" + item + "': there is no end '" + p.words + "'; " + form);
  if (stage.end == StageEnd::duration && stage.end_value < 0)
    throw std::invalid_argument("'" + item + "': a duration must not be negative");
}

void check_end(const Stage &stage, const bool last, const std::string &item)
{
  const std::string kind = name_of(stage.kind);
  if (stage.kind == StageKind::unload && stage.end != StageEnd::stress)
    throw std::invalid_argument("'" + item + "': unload ends at a stress");
  if (stage.kind == StageKind::constant_stress && stage.end == StageEnd::stress)
    throw std::invalid_argument("'" + item + "': the stress does not change");
  if (stage.kind == StageKind::hold && stage.end == StageEnd::strain)
    throw std::invalid_argument("'" + item + "': the strain does not change");
  if (stage.end == StageEnd::none && !last)
    throw std::invalid_argument("'" + item + "': only the last stage may go on without an end");
}
} // namespace

std::vector<Stage> parse_stages(const std::vector<std::string> &items)
{
  std::vector<Stage> stages;
  for (const std::string &item : items)
  {
    const std::string separator = " until ";
    const auto at = item.find(separator);
    Stage stage = stage_of_kind(read_phrase(item.substr(0, at), item), item);
    if (at != std::string::npos)
      add_end(stage, read_phrase(item.substr(at + separator.size()), item), item);
    check_end(stage, &item == &items.back(), item);
    stages.push_back(stage);
  }
  return stages;
}

std::string name_of(const StageKind kind)
{
  switch (kind)
  {
    case StageKind::strain_rate: return "strain rate";
    case StageKind::stress_rate: return "stress rate";
    case StageKind::constant_stress: return "constant stress";
    case StageKind::hold: return "hold";
    case StageKind::unload: return "unload";
  }
  throw std::logic_error("StageKind without a name");
}

std::string name_of(const StageEnd end)
{
  switch (end)
  {
    case StageEnd::none: return "no end";
    case StageEnd::duration: return "duration";
    case StageEnd::strain: return "strain";
    case StageEnd::stress: return "stress";
    case StageEnd::plastic_strain: return "plastic strain";
  }
  throw std::logic_error("StageEnd without a name");
}
} // namespace ddfem::coupling
