#pragma once

#include <cstddef>
#include <string>
#include <utility>
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
  /// Values from coarse to fine, where a finer one costs time and makes smaller errors; else empty. A sweep sets every
  /// such parameter of an algorithm to its k-th value together, so all of them have equally many.
  std::vector<std::string> sweep = {};

  /// A number from `low` to `high`, in `unit` (see the member).
  static Parameter number(std::string name, std::string meaning, std::string unit, std::string default_value,
                          double low, double high) {
    return {std::move(name), std::move(meaning), std::move(unit), std::move(default_value), low, high};
  }
  /// A whole number from `low` to `high`.
  static Parameter count(std::string name, std::string meaning, std::string default_value, double low, double high) {
    return {std::move(name), std::move(meaning), "1", std::move(default_value), low, high, true};
  }
  /// The same with values for sweeps.
  Parameter swept(std::vector<std::string> values) const {
    Parameter parameter = *this;
    parameter.sweep = std::move(values);
    return parameter;
  }

  /// One of these words.
  static Parameter choice(std::string name, std::string meaning, std::string default_value,
                          std::vector<std::string> choices) {
    return {.name = std::move(name),
            .meaning = std::move(meaning),
            .default_value = std::move(default_value),
            .choices = std::move(choices)};
  }
};

/// A value for every parameter of one algorithm; always complete and valid.
class Settings {
 public:
  /// All defaults. @throws BadArgument for a default, or a value of a sweep, that its parameter does not allow
  explicit Settings(std::vector<Parameter> parameters = {});

  /// Sets one value.
  /// @throws BadArgument if there is no such parameter, or the text is not a number in range or a choice
  void set(const std::string& parameter, const std::string& text);

  /// set() for each in turn. @param assignments each reads "parameter=value" @throws BadArgument as set() does
  void set_all(const std::vector<std::string>& assignments);

  double number(const std::string& parameter) const;              ///< Value of a numeric parameter.
  const std::string& choice(const std::string& parameter) const;  ///< Value of a parameter with choices.

  /// "parameter=value,parameter=value" of all parameters in their declared order: recorded with every result, and part
  /// of the keys of caches.
  std::string to_string() const;

 private:
  std::size_t find(const std::string& parameter) const;
  std::vector<Parameter> parameters_;
  std::vector<std::string> values_;
};

}  // namespace sixdof
