// The inner loops of gabor_tile.h, for gabor_loops.cpp, as gabor_lanes.h.

/// Places of a vector of columns or rows from a kernel's middle, and the wave of one axis there.
struct AxisWave {
  Floats distance, cosine, sine;

  [[gnu::always_inline]] AxisWave(const GaborTileAxis& axis, int first, std::int32_t middle, float part_of_middle,
                                  std::uint32_t turns, float turns_of_part_pixel, std::uint32_t phase) {
    const Ints whole = *reinterpret_cast<const Ints*>(axis.whole.data() + first) - middle;
    const Floats rest = load_lanes(axis.part.data() + first) - part_of_middle;
    distance = __builtin_convertvector(whole, Floats) + rest;
    Words sign;
    half_wave(reinterpret_cast<const Words&>(whole) * turns + phase + turns_of_part(rest * turns_of_part_pixel), cosine,
              sine, sign);
    cosine = with_sign(cosine, sign), sine = with_sign(sine, sign);
  }
};

/// Rows of all vectors of columns. A kernel's rows above x are those between the roots of (α x + σ y)² + β² y² = limit,
/// and those of an interval end where it comes next to the ellipse's lowest and highest point.
[[gnu::always_inline]] inline void find_rows(const AddToTile& add, float middle_x, float middle_y) {
  using Places = SixteenLanes::Floats;
  using Numbers = SixteenLanes::Ints;
  constexpr Numbers number{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const GaborShape& shape = add.shape;
  const auto step = static_cast<float>(add.x.step);
  const Places left = __builtin_convertvector(number, Places) * (16 * step) +
                      (static_cast<float>(add.x.start) - middle_x - bound_margin);
  const Places right = left + (15 * step + 2 * bound_margin);
  const float squares = shape.shear * shape.shear + shape.across * shape.across;
  const auto half_height = static_cast<float>(shape.half_height);
  const float highest = -shape.shear * half_height / shape.along;
  const float product = shape.along * shape.shear / squares;
  const float room = shape.limit / squares;
  const float narrowing = shape.along * shape.across / squares;
  const auto clamp = [&](float at) {
    Places x = at - Places{};
    x = x < left ? left : x;
    return x > right ? right : x;
  };
  const Places low_x = clamp(-highest), high_x = clamp(highest);
  Places low_square = room - (narrowing * narrowing) * (low_x * low_x);
  Places high_square = room - (narrowing * narrowing) * (high_x * high_x);
  low_square = low_square > 0 ? low_square : Places{}, high_square = high_square > 0 ? high_square : Places{};
  Places low, high;
  for (int i = 0; i < SixteenLanes::count; ++i) {
    low[i] = std::sqrt(low_square[i]);
    high[i] = std::sqrt(high_square[i]);
  }
  const float a_step = 1 / static_cast<float>(add.y.step);
  const float middle = middle_y - static_cast<float>(add.y.start);
  Places top = (middle - bound_margin - product * low_x - low) * a_step - 1;
  Places bottom = (middle + bound_margin - product * high_x + high) * a_step + 2;
  const auto last = static_cast<float>(add.y.count);
  top = top > 0 ? top : Places{}, bottom = bottom > 0 ? bottom : Places{};
  top = top < last ? top : last - Places{}, bottom = bottom < last ? bottom : last - Places{};
  reinterpret_cast<Numbers&>(add.room.top) = __builtin_convertvector(top, Numbers);
  reinterpret_cast<Numbers&>(add.room.bottom) = __builtin_convertvector(bottom, Numbers);
}

/// Columns and rows of a kernel.
[[gnu::always_inline]] inline void make_kernel(const AddToTile& add, const NearImpact& impact) {
  const GaborShape& shape = add.shape;
  const GaborTurns& turns = shape.turns[impact.entry];
  GaborTileRoom& room = add.room;
  const float middle_x = static_cast<float>(impact.x) + impact.part_x;
  const float middle_y = static_cast<float>(impact.y) + impact.part_y;
  const auto half_width = static_cast<float>(shape.half_width), half_height = static_cast<float>(shape.half_height);
  room.first_vector = index_before(add.x, middle_x - half_width) / 16;
  room.end_vector = (index_after(add.x, middle_x + half_width) + 15) / 16;
  const int first_row = index_before(add.y, middle_y - half_height) / Lanes::count * Lanes::count;
  const int end_row = index_after(add.y, middle_y + half_height);
  find_rows(add, middle_x, middle_y);
  const bool is_skewed = shape.shear != 0;
  for (int vector = room.first_vector; vector < room.end_vector; ++vector) {
    for (int lane = 0; lane < 16; lane += Lanes::count) {
      const AxisWave wave(add.x, 16 * vector + lane, impact.x, impact.part_x, turns.whole_x, turns.part_x, 0);
      const Floats u = shape.along * wave.distance, form = u * u;
      Floats window = exp2_of(-form);
      window = form < shape.limit ? window : Floats{};
      float* column = room.column(vector) + lane;
      store_lanes(is_skewed ? u : form, column);
      store_lanes(is_skewed ? wave.cosine : window * wave.cosine, column + 16);
      store_lanes(is_skewed ? wave.sine : window * wave.sine, column + 32);
    }
  }
  const std::complex<float>* color = shape.color(impact.entry);
  for (int first = first_row; first < end_row; first += Lanes::count) {
    const AxisWave wave(add.y, first, impact.y, impact.part_y, turns.whole_y, turns.part_y, impact.phase);
    const Floats v = shape.across * wave.distance, form = v * v, left_over = shape.limit - form;
    Floats window = exp2_of(-form) * impact.weight;
    window = left_over > 0 ? window : Floats{};
    const Floats cosine = window * wave.cosine, sine = window * wave.sine;
    float* row = room.rows.data() + first;
    store_lanes(left_over, row);
    store_lanes(shape.shear * wave.distance, row + GaborTileRoom::row_stride);
    for (int c = 0; c < shape.channels; ++c) {
      row += 2 * GaborTileRoom::row_stride;
      store_lanes(color[c].real() * cosine + color[c].imag() * sine, row);
      store_lanes(color[c].imag() * cosine - color[c].real() * sine, row + GaborTileRoom::row_stride);
    }
  }
}

/// Rows [top, bottom) of a kernel in one vector of columns. Of `width` channels from `channel` on.
template <int width, bool is_skewed>
[[gnu::always_inline]] inline void add_column(const float* column, const float* row, const float* colors, int top,
                                              int bottom, float* out, std::ptrdiff_t out_stride) {
  constexpr std::ptrdiff_t stride = GaborTileRoom::row_stride;
  const Floats place = load_lanes(column), cosine = load_lanes(column + 16), sine = load_lanes(column + 32);
  for (int y = top; y < bottom; ++y) {
    Floats real, imaginary;
    if constexpr (is_skewed) {
      const Floats u = place + row[y + stride], form = u * u;
      Floats window = exp2_of(-form);
      window = form < row[y] ? window : Floats{};
      real = window * cosine, imaginary = window * sine;
    } else {
      const auto is_inside = place < row[y];
      real = is_inside ? cosine : Floats{}, imaginary = is_inside ? sine : Floats{};
    }
    float* to = out + y * out_stride;
#pragma GCC unroll 8
    for (int c = 0; c < width; ++c, to += GaborTileSums::channel_stride) {
      Floats sum = load_lanes(to);
      sum = fused_lanes(all_lanes(colors[y + std::ptrdiff_t{2} * c * stride]), real, sum);
      sum = fused_lanes(all_lanes(colors[y + (std::ptrdiff_t{2} * c + 1) * stride]), imaginary, sum);
      store_lanes(sum, to);
    }
  }
}

template <int width, bool is_skewed>
[[gnu::always_inline]] inline void add_channels(const AddToTile& add, int channel) {
  const GaborTileRoom& room = add.room;
  const float* row = room.rows.data();
  const float* colors = row + (std::ptrdiff_t{2} * channel + 2) * GaborTileRoom::row_stride;
  for (int vector = room.first_vector; vector < room.end_vector; ++vector) {
    for (int lane = 0; lane < 16; lane += Lanes::count) {
      add_column<width, is_skewed>(room.column(vector) + lane, row, colors, room.top[vector], room.bottom[vector],
                                   add.sums.row(channel, 0) + std::ptrdiff_t{16} * vector + lane,
                                   add.sums.row_stride());
    }
  }
}

template <bool is_skewed>
[[gnu::always_inline]] inline void add_kernels_of(const AddToTile& add) {
  for (const NearImpact& impact : add.impacts) {
    make_kernel(add, impact);
    int channel = 0;
    for (; channel + 3 <= add.shape.channels; channel += 3) add_channels<3, is_skewed>(add, channel);
    for (; channel < add.shape.channels; ++channel) add_channels<1, is_skewed>(add, channel);
  }
}

void add_kernels(const AddToTile& add) {
  if (add.shape.shear == 0) {
    add_kernels_of<false>(add);
  } else {
    add_kernels_of<true>(add);
  }
}
