#include "plate/sections/profile.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "common/decimal_comma.hpp"
#include "common/error.hpp"

namespace chladni::plate {

namespace {

/// A formula of x, y, z, radius (from the z axis) and angle (about it, rad), read once.
class Formula {
 public:
  explicit Formula(const std::string& text) : text_(text)
  {
    if (const std::string wrong = decimal_comma_in(text); !wrong.empty())
      throw Error(fmt::format("formula \"{}\": {}", text, wrong));
    try {
      parser_.DefineVar("x", &x_);
      parser_.DefineVar("y", &y_);
      parser_.DefineVar("z", &z_);
      parser_.DefineVar("radius", &radius_);
      parser_.DefineVar("angle", &angle_);
      parser_.SetExpr(text);
      parser_.Eval();
    } catch (const mu::Parser::exception_type& e) {
      throw Error(fmt::format(
          "formula \"{}\": {}; it may use x, y, z and radius (m), angle (rad), numbers, + - * / ^ "
          "and functions such as sin, cos, sqrt, min, max",
          text, e.GetMsg()));
    }
  }
  Formula(const Formula&) = delete;  // the parser points at the variables
  Formula& operator=(const Formula&) = delete;

  double at(const std::array<double, 3>& position)
  {
    std::tie(x_, y_, z_) = std::tie(position[0], position[1], position[2]);
    radius_ = std::hypot(x_, y_);
    angle_ = std::atan2(y_, x_);
    const double value = parser_.Eval();
    if (std::isfinite(value)) return value;
    throw Error(fmt::format("formula \"{}\" is {} at ({:.6g}, {:.6g}, {:.6g}) m", text_, value, x_,
                            y_, z_));
  }

 private:
  std::string text_;
  mu::Parser parser_;
  double x_ = 0.0, y_ = 0.0, z_ = 0.0, radius_ = 0.0, angle_ = 0.0;
};

std::array<double, 3> turned_about_z(const std::array<double, 3>& x, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
}

Formula& formula(const std::string& text)
{
  static std::map<std::string, std::unique_ptr<Formula>> known;
  std::unique_ptr<Formula>& found = known[text];
  if (!found) found = std::make_unique<Formula>(text);
  return *found;
}

}  // namespace

double value_at(const Profile& profile, const std::array<double, 3>& place)
{
  const std::array<double, 3> position =
      profile.turned == 0.0 ? place : turned_about_z(place, profile.turned);
  if (!profile.formula.empty()) return formula(profile.formula).at(position);
  if (profile.at.empty()) return profile.values.front();
  const double s = profile.over == Coordinate::radius
                       ? std::hypot(position[0], position[1])
                       : position[static_cast<std::size_t>(profile.over)];
  const auto above = std::ranges::upper_bound(profile.at, s) - profile.at.begin();
  if (above == 0) return profile.values.front();
  if (above == std::ssize(profile.at)) return profile.values.back();
  const auto i = static_cast<std::size_t>(above);
  const double share = (s - profile.at[i - 1]) / (profile.at[i] - profile.at[i - 1]);
  return std::lerp(profile.values[i - 1], profile.values[i], share);
}

}  // namespace chladni::plate
