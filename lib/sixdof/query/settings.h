#pragma once

#include <map>
#include <string>
#include <vector>

namespace sixdof {

/// One parameter of an algorithm that a user may set, for accuracy or speed.
struct Parameter {
  std::string name;           ///< As typed on the command line: lower case, digits, '_'.
  std::string meaning;        ///< What it does, in a phrase.
  std::string unit;           ///< "1": a pure number; "diagonal": a fraction of a box's diagonal; empty with `choices`.
  std::string default_value;  ///< As text.
  double low = 0.0;           ///< Smallest allowed number.
  double high = 0.0;          ///< Largest allowed number.
  bool integer = false;       ///< Only whole numbers.
  std::vector<std::string> choices = {};  ///< If not empty, the value is one of these words instead of a number.
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

  /// "parameter=value,parameter=value" of all parameters in their declared order: recorded with every result, and part
  /// of the keys of caches.
  std::string to_string() const;

 private:
  const Parameter& find(const std::string& parameter) const;
  std::vector<Parameter> parameters_;
  std::map<std::string, std::string> values_;
};

}  // namespace sixdof
