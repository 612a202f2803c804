// What the harness costs beside the work: the time a run spends outside its own record (limit 15 ms), and a plan of
// 100,000 runs (limits 2 s and 300 MB).
#include <benchmark/benchmark.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "experiments/provenance.h"
#include "experiments/runner.h"

namespace textonbench {
namespace {

/// A folder that is gone at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = std::filesystem::temp_directory_path() / "harness_bench_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A sweep over that many seeds.
Config make_config(const ScratchFolder& folder, int seeds) {
  const std::filesystem::path file = folder.path() / "sweep.toml";
  std::ofstream out(file);
  out << "title = \"Sweep\"\nsource = \"benchmark\"\n[[runs]]\nname = \"sweep\"\nmethod = \"rpn\"\n"
         "exemplars = \"white_noise\"\nmetrics = \"mean_error\"\nseeds = [0";
  for (int seed = 1; seed < seeds; ++seed) out << ", " << seed;
  out << "]\n";
  out.close();
  return read_config(file, Profile::quick);
}

/// Of this process and of its children that have ended.
double cpu_seconds() {
  double sum = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& t : {usage.ru_utime, usage.ru_stime}) {
      sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    }
  }
  return sum;
}

/// The processor time is told as well: it says nearly the same on a machine that is busy with other things.
/// Children are forked, so this runs before anything starts threads.
void harness_time(benchmark::State& state) {
  constexpr int runs = 500;
  const ExemplarCatalog exemplars(home_folder());
  double overhead = 0, work = 0, cpu_overhead = 0;
  while (state.KeepRunning()) {
    const ScratchFolder folder;
    const Plan plan = make_plan(make_config(folder, runs), exemplars);
    const ResultsFolder results(folder.path() / "results");
    const double cpu_start = cpu_seconds();
    bool interrupted = false;
    const RunSummary summary = run_plan(plan, exemplars, results, {.show_progress = false}, &interrupted);
    if (summary.recorded != runs) throw std::runtime_error("a run failed");
    cpu_overhead = cpu_seconds() - cpu_start;
    work = 0;
    for (const Record& record : results.read().records) {
      work += record["time"]["wall_seconds"].get<double>();
      cpu_overhead -= record["time"]["cpu_seconds"].get<double>();
    }
    overhead = (summary.seconds - work) / runs;
  }
  state.counters["harness_ms_per_run"] = 1e3 * overhead;
  state.counters["harness_cpu_ms_per_run"] = 1e3 * cpu_overhead / runs;
  state.counters["work_ms_per_run"] = 1e3 * work / runs;
}

/// In a process of its own, whose peak memory is that of the plan.
void large_plan(benchmark::State& state) {
  constexpr int runs = 100000;
  struct Cost {
    double seconds;
    double bytes;
  };
  const ScratchFolder folder;
  const ExemplarCatalog exemplars(home_folder());
  Cost cost{};
  while (state.KeepRunning()) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child == 0) {
      const auto start = std::chrono::steady_clock::now();
      const Plan plan = make_plan(make_config(folder, runs), exemplars, runs);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      rusage usage{};
      getrusage(RUSAGE_SELF, &usage);
      const Cost own{seconds.count(), 1024.0 * static_cast<double>(usage.ru_maxrss)};
      _exit(plan.runs.size() == runs && write(ends[1], &own, sizeof own) == sizeof own ? 0 : 1);
    }
    close(ends[1]);
    if (read(ends[0], &cost, sizeof cost) != sizeof cost) throw std::runtime_error("the plan failed");
    close(ends[0]);
    waitpid(child, nullptr, 0);
  }
  state.counters["plan_seconds"] = cost.seconds;
  state.counters["plan_peak_mb"] = cost.bytes / 1e6;
}

BENCHMARK(harness_time)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK(large_plan)->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
}  // namespace textonbench

BENCHMARK_MAIN();
