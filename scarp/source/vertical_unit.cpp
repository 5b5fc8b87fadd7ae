// SPDX-License-Identifier: MIT
#include "scarp/source/vertical_unit.h"

#include <string>

namespace scarp {
namespace {

struct Unit {
  double metres;
  std::string_view names;  // lower case, letters only, each between blanks
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

}  // namespace

std::optional<double> metres_per_vertical_unit(std::string_view name) {
  // "U.S. survey foot", "us-ft" and "Foot_US" differ by case and punctuation only.
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

}  // namespace scarp
