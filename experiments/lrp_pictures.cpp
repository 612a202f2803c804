#include "experiments/lrp_pictures.h"

#include <array>

#include "experiments/metrics/lrp_diagrams.h"

namespace textonbench {
namespace {

template <LrpDiagram diagram>
Image make(const PictureSource& source) {
  return lrp_diagram(source.model, diagram, source.domain);
}

}  // namespace

std::span<const PictureEntry> lrp_pictures() {
  static constexpr std::array entries{
      PictureEntry{"lrp_power", "Welch's spectrum", make<LrpDiagram::power>},
      PictureEntry{"lrp_strata", "Strata", make<LrpDiagram::strata>},
      PictureEntry{"lrp_eroded", "Eroded strata", make<LrpDiagram::eroded>},
      PictureEntry{"lrp_parts", "Parts by k-means", make<LrpDiagram::parts>},
      PictureEntry{"lrp_windows", "Spectra of the windows of one draw", make<LrpDiagram::windows>},
      PictureEntry{"lrp_layer_1", "First stratum", make<LrpDiagram::layer_1>},
      PictureEntry{"lrp_layer_2", "Second stratum", make<LrpDiagram::layer_2>},
      PictureEntry{"lrp_layer_3", "Third stratum", make<LrpDiagram::layer_3>},
      PictureEntry{"lrp_layer_4", "Fourth stratum", make<LrpDiagram::layer_4>},
      PictureEntry{"lrp_variance", "Local variance", make<LrpDiagram::variance>},
      PictureEntry{"lrp_structure", "Structure image", make<LrpDiagram::structure>},
      PictureEntry{"lrp_reduced", "Reduced structure", make<LrpDiagram::reduced>},
      PictureEntry{"lrp_residual", "32 times what it lacks", make<LrpDiagram::residual>}};
  return entries;
}

}  // namespace textonbench
