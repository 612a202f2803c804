#include "experiments/execute.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <stdexcept>

#include "experiments/metrics/gaussian_limit.h"
#include "experiments/metrics/metric.h"
#include "experiments/observation.h"
#include "experiments/pictures.h"
#include "experiments/provenance.h"
#include "methods/base/image_io.h"

namespace textonbench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// User and system time of the process so far.
double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::int64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::string now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

/// The keys of every record, in order, with nothing measured.
Record blank_record(const RunSpec& spec, const std::string& status, const std::string& reason) {
  Record record = {{"schema", 1}, {"id", run_id(spec)}, {"status", status}};
  if (!reason.empty()) record["reason"] = reason;
  record["spec"] = to_json(spec);
  record["command"] = command_line(spec);
  record["exemplar"] = nullptr;
  record["metrics"] = Record::object();
  record["pictures"] = Record::object();
  record["time"] = {{"wall_seconds", nullptr}, {"cpu_seconds", nullptr}, {"peak_bytes", nullptr}, {"finished", now()}};
  record["provenance"] = provenance();
  record["provenance"]["code_version"] = code_version(spec);
  return record;
}

/// A number without standard error or floor.
MetricValue plain(double value) {
  MetricValue result;
  result.value = value;
  return result;
}

Record to_json(const MetricValue& value, std::string_view unit) {
  const auto or_null = [](const std::optional<double>& x) { return x ? Record(*x) : Record(nullptr); };
  return {
      {"value", value.value}, {"stderr", or_null(value.stderr_value)}, {"unit", unit}, {"floor", or_null(value.floor)}};
}

/// One run on its way from exemplar to numbers.
class Execution {
 public:
  /// `second` and `drawer` may be null.
  Execution(const RunSpec& spec, const Exemplar& exemplar, const Exemplar* second, FrameDrawer* drawer)
      : spec_(spec),
        exemplar_(exemplar),
        second_(second),
        drawer_(drawer),
        method_(find_method(spec.method)),
        params_(method_.params, spec.params),
        observed_(observation(method_, spec.params, exemplar.pixels.extent())),
        domain_{.size = spec.size.area() > 0 ? spec.size : exemplar.pixels.extent(),
                .step = spec.step,
                .periodic = spec.periodic} {}

  std::optional<std::string> refusal() const { return method_.refuses(problem(), params_, domain_); }

  void run() {
    analyze();
    synthesize();
    const bool needs_target =
        !spec_.pictures.empty() || std::any_of(spec_.metrics.begin(), spec_.metrics.end(), [](const std::string& name) {
          const MetricLevel level = find_metric(name).level;
          return level == MetricLevel::model || level == MetricLevel::sample;
        });
    if (needs_target) target_.emplace(make_target(exemplar_));
  }

  /// A metric that the model has no value of is left out.
  std::optional<MetricValue> measure(const MetricEntry& metric) {
    switch (metric.level) {
      case MetricLevel::model: {
        const std::optional<double> value = metric.of_model(*model_, *target_, domain_);
        return value ? std::optional(plain(*value)) : std::nullopt;
      }
      case MetricLevel::sample:
        return metric.of_limit != nullptr ? measure_against_limit(metric) : measure_on_samples(metric);
      case MetricLevel::cost:
        return plain(cost(metric.name));
      case MetricLevel::frame:
        if (drawer_ == nullptr) throw std::logic_error(fmt::format("{} without what draws frames", metric.name));
        return plain(drawer_->measure(metric.name, *model_, domain_, sample_seed(spec_.seed, 0)));
    }
    return std::nullopt;
  }

  Image picture(const PictureEntry& entry) const {
    return entry.make({.target = *target_, .model = *model_, .domain = domain_, .samples = samples_});
  }

 private:
  Problem problem() const {
    return {.exemplar = exemplar_, .second = second_, .observed = observed_ ? &*observed_ : nullptr};
  }
  Seed part(std::string_view name) const { return derive(Seed{spec_.seed}, name); }

  /// The first call also plans transforms and touches fresh memory, so a quick analysis is repeated and the first call
  /// left out of the median.
  void analyze() {
    constexpr double budget = 0.5;
    constexpr std::size_t most_repetitions = 6;
    std::vector<double> seconds;
    double spent = 0;
    do {
      const Clock::time_point start = Clock::now();
      model_ = method_.analyze(problem(), params_, analysis_seed(spec_.seed));
      seconds.push_back(seconds_since(start));
      spent += seconds.back();
    } while (wants("analyze_seconds") && spent < budget && seconds.size() < most_repetitions);
    if (seconds.size() > 1) seconds.erase(seconds.begin());
    analyze_seconds_ = median(seconds);
  }

  void synthesize() {
    // Untimed, like the first analysis.
    if (wants("synthesize_seconds") || wants("ns_per_pixel")) model_->synthesize(domain_, sample_seed(spec_.seed, 0));
    std::vector<double> seconds;
    for (int i = 0; i < spec_.samples; ++i) {
      const Clock::time_point start = Clock::now();
      const Seed seed = sample_seed(spec_.seed, i);
      samples_.push_back(drawer_ != nullptr ? drawer_->draw(*model_, domain_, seed)
                                            : model_->synthesize(domain_, seed));
      seconds.push_back(seconds_since(start));
    }
    synthesize_seconds_ = median(seconds);
  }

  bool wants(std::string_view metric) const {
    return std::find(spec_.metrics.begin(), spec_.metrics.end(), metric) != spec_.metrics.end();
  }

  double cost(std::string_view name) const {
    if (name == "analyze_seconds") return analyze_seconds_;
    if (name == "synthesize_seconds") return synthesize_seconds_;
    if (name == "ns_per_pixel") return 1e9 * synthesize_seconds_ / static_cast<double>(domain_.size.area());
    const Footprint footprint = model_->footprint(domain_);
    if (name == "model_bytes") return static_cast<double>(footprint.model_bytes);
    if (name == "operations_per_pixel") return footprint.operations_per_pixel;
    throw std::logic_error(fmt::format("nobody measures the cost metric \"{}\"", name));
  }

  /// What the metric draws itself depends on the run's seed and not on the method, so that methods are compared with
  /// common random numbers.
  MetricValue measure_on_samples(const MetricEntry& metric) {
    const Seed seed = derive(part("metric"), metric.name);
    MetricValue value = measure_samples(*metric.of_samples(*target_, domain_, seed), samples_, domain_);
    make_floor_samples();
    value.floor =
        measure_samples(*metric.of_samples(*target_, floor_domain_, seed), floor_samples_, floor_domain_).value;
    return value;
  }

  std::optional<MetricValue> measure_against_limit(const MetricEntry& metric) {
    const auto statistic = metric.of_limit(*model_, domain_, derive(part("metric"), metric.name));
    if (statistic == nullptr) return std::nullopt;
    MetricValue value = measure_samples(*statistic, samples_, domain_);
    if (const std::unique_ptr<Model> limit = gaussian_limit(*model_)) {
      std::vector<Image> floor_samples;
      floor_samples.reserve(static_cast<std::size_t>(spec_.samples));
      for (int i = 0; i < spec_.samples; ++i) {
        floor_samples.push_back(limit->synthesize(domain_, derive(part("limit"), static_cast<std::uint64_t>(i))));
      }
      value.floor = measure_samples(*statistic, floor_samples, domain_).value;
    }
    return value;
  }

  /// Samples of the exact Gaussian law of the target: circular ADSN of the periodic component on the exemplar's torus,
  /// or its non-circular form on the run's own window.
  void make_floor_samples() {
    if (!floor_samples_.empty()) return;
    floor_domain_ = domain_;
    if (spec_.periodic) floor_domain_.size = exemplar_.pixels.extent();
    const MethodEntry& adsn = find_method(floor_method);
    const Params params(adsn.params, {{"component", "periodic"}});
    const std::unique_ptr<Model> model = adsn.analyze(problem(), params, part("floor_analysis"));
    for (int i = 0; i < spec_.samples; ++i) {
      floor_samples_.push_back(model->synthesize(floor_domain_, derive(part("floor"), static_cast<std::uint64_t>(i))));
    }
  }

  const RunSpec& spec_;
  const Exemplar& exemplar_;
  const Exemplar* second_;
  FrameDrawer* drawer_;
  const MethodEntry& method_;
  Params params_;
  std::optional<Observation> observed_;
  Domain domain_;
  std::unique_ptr<Model> model_;
  double analyze_seconds_ = 0, synthesize_seconds_ = 0;
  std::vector<Image> samples_;
  std::optional<Target> target_;
  Domain floor_domain_;
  std::vector<Image> floor_samples_;
};

/// A stack is kept as one picture of its maps side by side.
Record keep(const Image& made, std::span<const ImageMap> maps, const std::string& name, const ResultsFolder& results) {
  const Image picture = maps.empty() ? Image(made) : side_by_side(made, maps);
  const std::filesystem::path folder = results.path() / "pictures";
  std::filesystem::create_directories(folder);
  const std::filesystem::path draft = folder / fmt::format(".draft_{}_{}.png", ::getpid(), name);
  write_image(picture, draft);
  return {{"file", results.keep_picture(draft)}, {"width", picture.width()}, {"height", picture.height()}};
}

}  // namespace

Seed analysis_seed(std::uint64_t seed) { return derive(Seed{seed}, "analysis"); }

Seed sample_seed(std::uint64_t seed, int index) {
  return derive(derive(Seed{seed}, "sample"), static_cast<std::uint64_t>(index));
}

Record unsuccessful_record(const RunSpec& spec, const std::string& status, const std::string& reason) {
  return blank_record(spec, status, reason);
}

Record execute(const RunSpec& spec, const ExemplarCatalog& exemplars, const ResultsFolder* results,
               FrameDrawer* drawer) {
  const Clock::time_point start = Clock::now();
  const double cpu_start = cpu_seconds();
  if (spec.samples < 1) throw std::invalid_argument(fmt::format("samples = {}: expected at least 1", spec.samples));
  if (results == nullptr && !spec.pictures.empty()) {
    throw std::invalid_argument("pictures are asked for and there is no results folder to keep them in");
  }
  const Exemplar exemplar = load_exemplar(find_exemplar(exemplars, spec.exemplar));
  if (!spec.exemplar_sha256.empty() && exemplar.sha256 != spec.exemplar_sha256) {
    throw std::invalid_argument(fmt::format("exemplar {} has changed: expected SHA-256 {}, found {}", exemplar.name,
                                            spec.exemplar_sha256, exemplar.sha256));
  }
  require_usable(exemplar);
  const MethodEntry& method = find_method(spec.method);
  if (hash_named(method, spec.params, exemplars) != spec.file_sha256) {
    throw std::invalid_argument("a file that an option names has changed since the run was planned: plan it again");
  }
  std::optional<Exemplar> second;
  if (const auto named = second_exemplar(method, spec.params, exemplars)) second = load_exemplar(*named);

  Execution execution(spec, exemplar, second ? &*second : nullptr, drawer);
  const std::optional<std::string> refusal = execution.refusal();
  Record record = refusal ? blank_record(spec, "refused", *refusal) : blank_record(spec, "ok", "");
  record["exemplar"] = {{"width", exemplar.pixels.width()},
                        {"height", exemplar.pixels.height()},
                        {"channels", exemplar.pixels.channels()}};
  if (!refusal) {
    execution.run();
    for (const std::string& name : spec.metrics) {
      const MetricEntry& metric = find_metric(name);
      if (const std::optional<MetricValue> value = execution.measure(metric)) {
        record["metrics"][name] = to_json(*value, metric.unit);
      }
    }
    for (const std::string& name : spec.pictures) {
      record["pictures"][name] = keep(execution.picture(find_picture(name)), exemplar.maps, name, *results);
    }
  }
  if (drawer != nullptr) drawer->describe(record);
  record["time"] = {{"wall_seconds", seconds_since(start)},
                    {"cpu_seconds", cpu_seconds() - cpu_start},
                    {"peak_bytes", peak_bytes()},
                    {"finished", now()}};
  return record;
}

}  // namespace textonbench
