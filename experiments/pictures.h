// Pictures that a run can keep for the figures.
#pragma once

#include <span>
#include <string_view>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// What a picture is made from. `samples` are the run's samples in order.
struct PictureSource {
  const Target& target;
  const Model& model;
  const Domain& domain;
  std::span<const Image> samples;
};

struct PictureEntry {
  std::string_view name;  ///< "sample", "sample_2", "sample_3", "exemplar", "periodic_component", "smooth_component", …
  std::string_view title;
  Image (*make)(const PictureSource&);  ///< as many channels as the exemplar
};

/// sample, sample_2, sample_3 (the first three samples), exemplar, periodic_component, smooth_component (plus 1/2),
/// exemplar_modulus, periodic_modulus, exemplar_phase, sample_modulus, mean_modulus (of the mean power of all samples),
/// texton, sample_far, sample_near (close-ups of the first sample: of a view of the ground), sample_phase, and those of
/// conditional_pictures.h and lrp_pictures.h.
std::span<const PictureEntry> picture_catalog();
/// Throws std::invalid_argument naming the nearest known name.
const PictureEntry& find_picture(std::string_view name);

}  // namespace textonbench
