#include "manyworlds/live.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "src/base/pimpl.hpp"
#include "src/live/impl.hpp"

namespace manyworlds {
namespace {

// How often all that can be shown is captured, for pages that are opened while nothing steps: not
// more often than this, and so that it takes no more than this share of the time.
constexpr auto kIdle = std::chrono::milliseconds(250);
constexpr int kIdleShare = 200;

const LiveOptions& checked(const LiveOptions& options) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("live: " + what); };
  if (options.port < 0 || options.port > 65535) {
    refuse("port is " + std::to_string(options.port) + ", must be 0 to 65535");
  }
  if (options.worlds < 1 || options.max_worlds < options.worlds) {
    refuse("worlds is " + std::to_string(options.worlds) + ", must be 1 to max_worlds, " +
           std::to_string(options.max_worlds));
  }
  return options;
}

live::Sizes sizes_of(const Batch& batch, int most) {
  live::Sizes out;
  int first = 0;
  for (int k = 0; k < batch.kinds(); ++k) {
    int worlds = 0;
    while (first + worlds < batch.worlds() && batch.kind_of(first + worlds) == k) ++worlds;
    out.kinds.push_back({batch.plan(k), first, worlds});
    first += worlds;
  }
  out.shown = std::min(most, batch.worlds());
  return out;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw LiveError("live: page '" + file.string() + "' cannot be read");
  return text;
}

}  // namespace

Live::Impl::Impl(Batch& batch, const LiveOptions& given)
    : options(checked(given)),
      sizes(sizes_of(batch, given.max_worlds)),
      head(batch, sizes, given),
      sliders(live::sliders_of(sizes)),
      seen_steps(batch.steps()) {
  if (options.folder.empty()) options.folder = std::filesystem::current_path();
  hub.resize(std::make_shared<live::VariedSizes>(head.measure(batch)), false);
  std::string page = text_of(options.page);
  show(batch);
  server = std::make_unique<live::Server>(live::Server::Content{hub, head, sizes, std::move(page)},
                                          live::make_token(), options.port);
}

void Live::Impl::publish(const Batch& batch, std::vector<int> worlds, bool of_all) {
  auto capture = std::make_shared<live::Capture>(live::capture(batch, sizes, std::move(worlds)));
  capture->version = version;
  capture->steps = batch.steps();
  capture->time = batch.time();
  capture->lost = batch.lost_worlds();
  capture->clock = clockwork;
  hub.publish(std::move(capture), of_all);
}

void Live::Impl::show(const Batch& batch) {
  // Steps of single worlds count nowhere: others that call this have something new to show.
  if (!options.clock || batch.steps() != seen_steps) changed();
  seen_steps = batch.steps();
  if (hub.any_want()) {
    std::vector<int> worlds = hub.take_wants(version);
    if (!worlds.empty()) publish(batch, std::move(worlds), false);
  }
  // run() is there when a page is opened; others may not step for a long time then.
  if (options.clock && next_all != Clock::time_point{}) return;
  if (const Clock::time_point now = Clock::now(); now >= next_all) {
    std::vector<int> all(static_cast<std::size_t>(sizes.shown));
    for (int w = 0; w < sizes.shown; ++w) all[static_cast<std::size_t>(w)] = w;
    publish(batch, std::move(all), true);
    const Clock::time_point end = Clock::now();
    next_all = end + std::max<Clock::duration>(kIdle, kIdleShare * (end - now));
  }
}

Live::Live(Batch& batch, const LiveOptions& options) : impl_(Pimpl<Impl>::make(batch, options)) {}
Live::~Live() = default;
Live::Live(Live&&) noexcept = default;
Live& Live::operator=(Live&&) noexcept = default;

std::string Live::url() const { return impl_->server ? impl_->server->access().url() : ""; }
int Live::port() const { return impl_->server ? impl_->server->access().port() : 0; }
int Live::pages() const { return impl_->server ? impl_->server->pages() : 0; }
void Live::close() { impl_->server.reset(); }
void Live::apply(Batch& batch, int steps) {
  const auto use = impl_.operator->();
  use->obey(batch);
  use->pull(batch, steps);
}
void Live::show(const Batch& batch) { impl_->show(batch); }

}  // namespace manyworlds
