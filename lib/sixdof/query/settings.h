#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sixdof {

/// One accuracy or speed parameter of an algorithm, as data.
struct Parameter {
  std::string name;      ///< As typed on the command line: lower case, digits, '_'.
  std::string meaning;   ///< One sentence.
  std::string unit;      ///< "1" for pure numbers, "diagonal" for fractions of A's box diagonal, "ns", ...
  std::string standard;  ///< Default value, as text.
  double low = 0.0;      ///< Smallest allowed number.
  double high = 0.0;     ///< Largest allowed number.
  bool integer = false;  ///< Only whole numbers.
  std::vector<std::string> choices = {};  ///< Non-empty: a word out of these instead of a number.
};

/// A value for every parameter of one algorithm; always complete and valid.
class Settings {
 public:
  /// All defaults.
  explicit Settings(std::vector<Parameter> parameters = {});

  /// @throws BadArgument naming the parameter if there is none of that name, or the text is not a number in range or a
  /// choice.
  void set(const std::string& parameter, const std::string& text);

  /// Each assignment reads "parameter=value". @throws BadArgument
  void set_all(const std::vector<std::string>& assignments);

  double number(const std::string& parameter) const;              ///< Value of a numeric parameter.
  const std::string& choice(const std::string& parameter) const;  ///< Value of a parameter with choices.

  const std::vector<Parameter>& parameters() const { return parameters_; }

  /// "parameter=value,parameter=value" of all parameters in their declared order: printed beside every result, key of caches.
  std::string to_string() const;

  /// The same for parameters that differ from their default; empty when none does.
  std::string differences() const;

 private:
  const Parameter& find(const std::string& parameter) const;
  std::vector<Parameter> parameters_;
  std::map<std::string, std::string> values_;
};

}  // namespace sixdof
