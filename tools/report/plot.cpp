#include "tools/report/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/report/page.hpp"

namespace manyworlds::report {
namespace {

constexpr double kWidth = 560, kHeight = 380, kLeft = 70, kRight = 190, kTop = 12, kBottom = 46;
// Told apart also by those who see fewer colours (Okabe, Ito).
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000", "#999999"};

bool drawable(double v) { return std::isfinite(v) && v > 0; }

// Whole decades about the values.
class Axis {
 public:
  void include(double v) {
    if (!drawable(v)) return;
    low_ = std::min(low_, std::floor(std::log10(v)));
    high_ = std::max(high_, std::ceil(std::log10(v)));
  }
  void finish() {
    if (low_ > high_) low_ = -1, high_ = 1;
    if (low_ == high_) high_ += 1;
  }
  double share(double v) const { return (std::log10(v) - low_) / (high_ - low_); }
  // Exponents to label: each, or fewer where there are many.
  std::vector<int> ticks() const {
    const int low = static_cast<int>(low_), high = static_cast<int>(high_);
    const int stride = 1 + (high - low) / 10;
    std::vector<int> out;
    for (int e = low; e <= high; e += stride) out.push_back(e);
    return out;
  }

 private:
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

struct Frame {
  Axis x, y;
  double at_x(double v) const { return kLeft + x.share(v) * (kWidth - kLeft - kRight); }
  double at_y(double v) const {
    return kHeight - kBottom - y.share(v) * (kHeight - kTop - kBottom);
  }
};

std::string grid(const Frame& f) {
  std::string out;
  for (const int e : f.x.ticks()) {
    const double x = f.at_x(std::pow(10, e));
    out += fmt::format(
        "<line x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}' class='g'/><text x='{0:.1f}' y='{3}' "
        "text-anchor='middle'>1e{4}</text>",
        x, kTop, kHeight - kBottom, kHeight - kBottom + 16, e);
  }
  for (const int e : f.y.ticks()) {
    const double y = f.at_y(std::pow(10, e));
    out += fmt::format(
        "<line x1='{1}' x2='{2}' y1='{0:.1f}' y2='{0:.1f}' class='g'/><text x='{3}' y='{4:.1f}' "
        "text-anchor='end'>1e{5}</text>",
        y, kLeft, kWidth - kRight, kLeft - 6, y + 4, e);
  }
  return out;
}

std::string drawn(const Curve& curve, const Frame& f, const char* colour) {
  std::string points, marks;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!drawable(curve.x[i]) || !drawable(curve.y[i])) continue;
    const double x = f.at_x(curve.x[i]), y = f.at_y(curve.y[i]);
    points += fmt::format("{:.1f},{:.1f} ", x, y);
    marks += curve.marks_only
                 ? fmt::format("<path d='M{0:.1f} {1:.1f}l8 8m0 -8l-8 8' stroke='{2}'/>", x - 4,
                               y - 4, colour)
                 : fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'/>", x, y, colour);
  }
  if (curve.marks_only) return marks;
  return fmt::format("<polyline points='{}' fill='none' stroke='{}' {}/>", points, colour,
                     curve.dashed ? "stroke-dasharray='5 3'" : "") +
         marks;
}

}  // namespace

std::string to_svg(const LogPlot& plot) {
  Frame f;
  for (const Curve& c : plot.curves) {
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      if (drawable(c.x[i]) && drawable(c.y[i])) f.x.include(c.x[i]), f.y.include(c.y[i]);
    }
  }
  if (plot.level > 0) f.y.include(plot.level);
  f.x.finish(), f.y.finish();

  std::string out = fmt::format("<svg viewBox='0 0 {} {}' role='img'>", kWidth, kHeight);
  out += grid(f);
  if (plot.level > 0) {
    const double y = f.at_y(plot.level);
    out += fmt::format("<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' class='level'/>", kLeft,
                       kWidth - kRight, y, y);
  }
  // Curves that differ in their dashes only share a colour.
  std::vector<std::string> names;
  double row = kTop + 8;
  for (const Curve& c : plot.curves) {
    auto known = std::find(names.begin(), names.end(), c.name);
    const bool fresh = known == names.end();
    if (fresh) known = names.insert(names.end(), c.name);
    const char* colour =
        kColours[static_cast<std::size_t>(known - names.begin()) % std::size(kColours)];
    out += drawn(c, f, colour);
    if (!fresh) continue;
    out += fmt::format(
        "<rect x='{0}' y='{1:.1f}' width='10' height='10' fill='{2}'/><text x='{3}' y='{4:.1f}'>{5}"
        "</text>",
        kWidth - kRight + 10, row - 8, colour, kWidth - kRight + 25, row + 1, escaped(c.name));
    row += 17;
  }
  out += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>{}</text>",
                     (kLeft + kWidth - kRight) / 2, kHeight - 8, escaped(plot.x_label));
  out += fmt::format(
      "<text transform='translate(14 {:.0f}) rotate(-90)' text-anchor='middle'>{}</text></svg>",
      (kTop + kHeight - kBottom) / 2, escaped(plot.y_label));
  return out;
}

}  // namespace manyworlds::report
