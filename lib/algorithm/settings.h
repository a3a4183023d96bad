#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sixdof {

/// One accuracy or speed parameter of an algorithm, as data.
struct Knob {
  std::string name;      ///< As typed on the command line: lower case, digits, '_'.
  std::string meaning;   ///< One sentence.
  std::string unit;      ///< "1" for pure numbers, "diagonal" for fractions of A's box diagonal, "ns", ...
  std::string standard;  ///< Default value, as text.
  double low = 0.0;      ///< Smallest allowed number.
  double high = 0.0;     ///< Largest allowed number.
  bool integer = false;  ///< Only whole numbers.
  std::vector<std::string> choices = {};  ///< Non-empty: a word out of these instead of a number.
};

/// A value for every knob of one algorithm; always complete and valid.
class Settings {
 public:
  /// All defaults.
  explicit Settings(std::vector<Knob> knobs = {});

  /// @throws BadArgument naming the knob if there is none of that name, or the text is not a number in range or a
  /// choice.
  void set(const std::string& knob, const std::string& text);

  /// Each assignment reads "knob=value". @throws BadArgument
  void set_all(const std::vector<std::string>& assignments);

  double number(const std::string& knob) const;              ///< Value of a numeric knob.
  const std::string& choice(const std::string& knob) const;  ///< Value of a knob with choices.

  const std::vector<Knob>& knobs() const { return knobs_; }

  /// "knob=value,knob=value" of all knobs in their declared order: printed beside every result, key of caches.
  std::string to_string() const;

  /// The same for knobs that differ from their default; empty when none does.
  std::string differences() const;

 private:
  const Knob& find(const std::string& knob) const;
  std::vector<Knob> knobs_;
  std::map<std::string, std::string> values_;
};

}  // namespace sixdof
