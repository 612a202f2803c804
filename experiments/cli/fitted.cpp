#include "experiments/cli/fitted.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

#include "experiments/execute.h"
#include "experiments/observation.h"
#include "experiments/provenance.h"

namespace textonbench::cli {

Fitted fit_to_exemplar(const ModelOptions& asked, bool quiet) {
  const MethodEntry& method = find_method(asked.method);
  const Params params = asked.read_params(method);
  const ExemplarCatalog catalog(home_folder());
  std::vector<std::string> notes;
  const Exemplar exemplar = load_exemplar(find_exemplar(catalog, asked.exemplar), &notes);
  if (!quiet) {
    for (const std::string& note : notes) fmt::print(stderr, "{}: {}\n", exemplar.name, note);
  }
  require_usable(exemplar);
  std::optional<Exemplar> second;
  if (const auto named = second_exemplar(method, params.values(), catalog)) second = load_exemplar(*named);
  const std::optional<Observation> observed = observation(method, params.values(), exemplar.pixels.extent());
  const Problem problem{exemplar, second ? &*second : nullptr, observed ? &*observed : nullptr};
  const Domain domain = asked.read_domain(method, problem, params);
  if (const std::optional<std::string> reason = method.refuses(problem, params, domain)) {
    throw std::invalid_argument(fmt::format("{} cannot do this: {}", asked.method, *reason));
  }
  const auto start = std::chrono::steady_clock::now();
  std::unique_ptr<Model> model = method.analyze(problem, params, analysis_seed(asked.seed));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return {std::move(model), exemplar.maps, domain, seconds.count(), params.values()};
}

}  // namespace textonbench::cli
