// A picture of curves over two logarithmic axes, as SVG that needs nothing else.
#pragma once

#include <string>
#include <vector>

namespace manyworlds::report {

struct Curve {
  std::string name;
  bool dashed = false;
  bool marks_only = false;
  std::vector<double> x, y;  // what is not finite or not positive is left out
};
struct LogPlot {
  std::string x_label, y_label;
  std::vector<Curve> curves;
  double level = 0;  // a line across, if positive
};

std::string to_svg(const LogPlot& plot);

}  // namespace manyworlds::report
