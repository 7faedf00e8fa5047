#pragma once
#include <string>

namespace sheer {

/// `value` for people: rounded to `digits` significant digits, but never left of the decimal point, and without an
/// exponent between 1e-9 and 1e15: 1600, 165, 1.41, 0.0174.
std::string number_text(double value, int digits = 3);

/// The same with as many digits as are needed to see on which side of `limit` it lies: 0.05003 beside 0.05. A value
/// equal to `limit` is given in full.
std::string number_text_beside(double value, double limit);

/// `value` in full: the fewest digits that read back as the same number.
std::string full_number_text(double value);

}  // namespace sheer
