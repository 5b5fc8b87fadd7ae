// SPDX-License-Identifier: MIT
#include "scarp/base/vertical_unit.h"

#include <cmath>
#include <string>

namespace scarp {
namespace {

struct Unit {
  double metres;
  std::string_view names;  // lower case, letters only, separated by blanks
};

constexpr double kFoot = 0.3048;                   // international foot, 1959
constexpr double kUsSurveyFoot = 1200.0 / 3937.0;  // Mendenhall order, 1893

constexpr Unit kUnits[] = {
    {1.0, " m metre metres meter meters mtr "},
    {kFoot, " ft foot feet internationalfoot internationalfeet footinternational intlfoot intlfeet ift "},
    {kUsSurveyFoot, " usft ftus ussurveyfoot ussurveyfeet usfoot usfeet footus feetus surveyfoot surveyfeet sft "},
    {1000.0, " km kilometre kilometres kilometer kilometers "},
    {0.1, " dm decimetre decimetres decimeter decimeters "},
    {0.01, " cm centimetre centimetres centimeter centimeters "},
    {0.001, " mm millimetre millimetres millimeter millimeters "},
    {3 * kFoot, " yd yard yards "},
    {6 * kFoot, " fathom fathoms "},
};

// Relative differences: feet of other countries (Clarke's, Indian, Gold Coast) differ from the international foot by at
// most 5e-5, the two US feet by 2e-6, and texts of the same unit only by their rounding, about 1e-9.
constexpr double kFeetDiffer = 1e-4, kSameLength = 1e-7;

}  // namespace

std::optional<double> metres_per_vertical_unit(std::string_view name) {
  // "1/3 ft", "10 m" and "m^2" are not the unit that they contain.
  if (name.find_first_of("0123456789/*^%") != std::string_view::npos) return {};
  // "U.S. survey foot", "us-ft" and "Foot_US" differ only in case and punctuation.
  std::string plain = " ";
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') plain += static_cast<char>(c - 'A' + 'a');
    if (c >= 'a' && c <= 'z') plain += c;
  }
  if (plain.size() == 1) return {};
  plain += ' ';
  for (const Unit& unit : kUnits) {
    if (unit.names.find(plain) != std::string_view::npos) return unit.metres;
  }
  return {};
}

std::string_view foot_of(double metres) {
  if (!(std::abs(metres - kFoot) <= kFeetDiffer * kFoot)) return "";
  return std::abs(metres - kUsSurveyFoot) <= kSameLength * kFoot ? "us-ft" : "ft";
}

}  // namespace scarp
