// The frame of a report's page: one HTML file that needs no network.
#pragma once

#include <string>
#include <vector>

namespace manyworlds::report {

// &, < and > as HTML wants them.
std::string escaped(const std::string& text);

// The first row is the head; cells are escaped.
std::string table(const std::vector<std::vector<std::string>>& rows);
// `body` is HTML.
std::string page(const std::string& title, const std::string& machine, const std::string& body);

std::string time_text(double microseconds);  // "12.3 ms"
std::string speed_text(double per_second);   // "1.25 M/s"

}  // namespace manyworlds::report
