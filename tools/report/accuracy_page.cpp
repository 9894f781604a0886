// The accuracy report as one HTML page that needs no network.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/report/accuracy.hpp"
#include "tools/report/page.hpp"
#include "tools/report/plot.hpp"

namespace manyworlds::report {
namespace {

// Run time to the level, cheapest first.
std::string level_table(const CaseResult& r) {
  std::vector<Point> reached = r.reached();
  std::sort(reached.begin(), reached.end(),
            [](const Point& a, const Point& b) { return a.microseconds < b.microseconds; });
  if (reached.empty()) {
    return fmt::format("<p>No method reaches {:g} {} here.</p>", r.of.level, escaped(r.of.unit));
  }
  std::vector<std::vector<std::string>> rows = {
      {"method", "precision", "step", "error", "run time per world"}};
  for (const Point& p : reached) {
    rows.push_back({p.method, to_string(p.precision), fmt::format("{:.3g} ms", 1e3 * p.step),
                    fmt::format("{:.2g}", p.error), time_text(p.microseconds)});
  }
  return table(rows);
}

std::string picture(const CaseResult& r) {
  LogPlot plot;
  plot.x_label = "run time per world, s";
  plot.y_label = "error, " + r.of.unit;
  plot.level = r.of.level;
  for (const Point& p : r.points) {
    const bool dashed = p.precision == Precision::f32;
    auto curve = std::find_if(plot.curves.begin(), plot.curves.end(), [&](const Curve& c) {
      return c.name == p.method && c.dashed == dashed;
    });
    if (curve == plot.curves.end()) {
      plot.curves.push_back({p.method, dashed, false, {}, {}});
      curve = plot.curves.end() - 1;
    }
    curve->x.push_back(p.microseconds * 1e-6), curve->y.push_back(p.error);
  }
  for (const Published& p : r.of.published) {
    if (!std::isfinite(p.seconds)) continue;
    auto curve = std::find_if(plot.curves.begin(), plot.curves.end(),
                              [&](const Curve& c) { return c.name == p.engine; });
    if (curve == plot.curves.end()) {
      plot.curves.push_back({p.engine, false, true, {}, {}});
      curve = plot.curves.end() - 1;
    }
    curve->x.push_back(p.seconds), curve->y.push_back(p.error);
  }
  return to_svg(plot);
}

std::string published_table(const CaseResult& r) {
  if (r.of.published.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"published", "step", "error", "wall time there"}};
  for (const Published& p : r.of.published) {
    rows.push_back({p.engine, fmt::format("{:.3g} ms", 1e3 * p.step),
                    fmt::format("{:.3g}", p.error),
                    std::isfinite(p.seconds) ? fmt::format("{:.3g} s", p.seconds) : ""});
  }
  return table(rows);
}

std::string headline(const std::vector<CaseResult>& results) {
  std::vector<std::vector<std::string>> rows = {
      {"case", "error asked for", "cheapest method", "step", "run time per world"}};
  for (const CaseResult& r : results) {
    const std::vector<Point> reached = r.reached();
    const auto best = std::min_element(
        reached.begin(), reached.end(),
        [](const Point& a, const Point& b) { return a.microseconds < b.microseconds; });
    rows.push_back({r.of.id + " " + r.of.title, fmt::format("{:g} {}", r.of.level, r.of.unit)});
    if (best == reached.end()) {
      rows.back().insert(rows.back().end(), {"none", "", ""});
    } else {
      rows.back().push_back(best->method + ", " + to_string(best->precision));
      rows.back().push_back(fmt::format("{:.3g} ms", 1e3 * best->step));
      rows.back().push_back(time_text(best->microseconds));
    }
  }
  return table(rows);
}

}  // namespace

std::string accuracy_page(const std::vector<CaseResult>& results, const std::string& machine) {
  std::string out =
      "<p>One thread, as many worlds as the registers hold, fastest of up to five runs; the run "
      "time is that of the whole simulated time divided by the worlds. Lines are float64, dashes "
      "float32; crosses are what others published, on their machines.</p>";
  out += headline(results);
  for (const CaseResult& r : results) {
    out += fmt::format("<h2>{} {}</h2><p>Error: {} ({}), after {:g} s.</p>", escaped(r.of.id),
                       escaped(r.of.title), escaped(r.of.metric), escaped(r.of.unit), r.seconds);
    out += picture(r) + level_table(r) + published_table(r);
  }
  return page("Error against run time", machine, out);
}

}  // namespace manyworlds::report
