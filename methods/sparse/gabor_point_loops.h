// The inner loops of gabor_point_sum.h, for gabor_loops.cpp, as gabor_lanes.h.

/// The points of one vector, from `first` on. Of `width` channels, or of any number where that is 0.
template <int width, bool is_skewed>
[[gnu::always_inline]] inline void add_to_vector(const AddImpacts& add, int first) {
  const GaborShape& shape = add.shape;
  const int channels = width == 0 ? shape.channels : width;
  const auto x = *reinterpret_cast<const Ints*>(add.points.x + first);
  const auto y = *reinterpret_cast<const Ints*>(add.points.y + first);
  const auto part_x = *reinterpret_cast<const Floats*>(add.points.part_x + first);
  const auto part_y = *reinterpret_cast<const Floats*>(add.points.part_y + first);
  const float along = shape.along, shear = shape.shear, across = shape.across, limit = shape.limit;
  Floats sum[width == 0 ? Image::max_channels : width] = {};
#pragma GCC unroll 8
  for (int c = 0; c < channels; ++c) sum[c] = load_lanes(add.sums + std::ptrdiff_t{c} * GaborPoints::most + first);
  const std::uint32_t* number = add.chosen.number.data();
  const NearImpact* impacts = add.impacts.data();
  const GaborTurns* all_turns = shape.turns.data();
  for (int i = 0; i < add.chosen.count; ++i) {
    const NearImpact& impact = impacts[number[i]];
    const GaborTurns& turns = all_turns[impact.entry];
    const std::complex<float>* color = shape.color(impact.entry);
    const Ints whole_x = x - impact.x, whole_y = y - impact.y;
    const Floats rest_x = part_x - impact.part_x, rest_y = part_y - impact.part_y;
    const Floats dx = __builtin_convertvector(whole_x, Floats) + rest_x;
    const Floats dy = __builtin_convertvector(whole_y, Floats) + rest_y;
    const Floats v = across * dy;
    Floats u = along * dx;
    if constexpr (is_skewed) u = u + shear * dy;
    const Floats left_over = (limit - v * v) - u * u;
    const Words turn = reinterpret_cast<const Words&>(whole_x) * turns.whole_x +
                       reinterpret_cast<const Words&>(whole_y) * turns.whole_y + impact.phase +
                       turns_of_part(fused_lanes(rest_x, all_lanes(turns.part_x), rest_y * turns.part_y));
    Floats cosine, sine;
    Words sign;
    half_wave(turn, cosine, sine, sign);
    Floats window = exp2_of(left_over) * impact.weight;
    window = left_over > 0 ? with_sign(window, sign) : Floats{};
    cosine *= window, sine *= window;
#pragma GCC unroll 8
    for (int c = 0; c < channels; ++c) {
      sum[c] = fused_lanes(all_lanes(color[c].real()), cosine, sum[c]);
      sum[c] = fused_lanes(all_lanes(color[c].imag()), sine, sum[c]);
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < channels; ++c) store_lanes(sum[c], add.sums + std::ptrdiff_t{c} * GaborPoints::most + first);
}

template <int width>
[[gnu::always_inline]] inline void add_to_vectors(const AddImpacts& add) {
  for (int first = 0; first < GaborPoints::most; first += Lanes::count) {
    if (add.shape.shear == 0) {
      add_to_vector<width, false>(add, first);
    } else {
      add_to_vector<width, true>(add, first);
    }
  }
}

void add_channels_at_points(const AddImpacts& add) {
  if (add.shape.channels == 1) {
    add_to_vectors<1>(add);
  } else if (add.shape.channels == 3) {
    add_to_vectors<3>(add);
  } else {
    add_to_vectors<0>(add);
  }
}
