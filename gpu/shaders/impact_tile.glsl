// The impacts that reach a tile of 16 x 16 pixels, drawn once by the threads of its work group. They come in the order
// of cells and of impacts in each, so that sums have the same order in every run.

const uint group_size = 256u;
const uint list_size = 512u;

shared uint tile_ends[group_size];       // impacts of the cells up to each one
shared uint tile_kept[group_size / 32u]; // a bit a thread
shared ivec4 tile_impacts[list_size];
shared ivec2 tile_margin;
#ifdef CELL_STARTS
shared uint tile_starts[group_size];     // of each cell, the number of its impacts' first word
#endif

// Largest margin of the group.
ivec2 margin_of_group(ivec2 margin) {
#if FILTER == 0 || WINDOW_KERNEL
  return ivec2(0);
#else
  barrier();  // all have read the last one
  if (gl_LocalInvocationIndex == 0u) tile_margin = ivec2(0);
  barrier();
  atomicMax(tile_margin.x, margin.x);
  atomicMax(tile_margin.y, margin.y);
  barrier();
  return tile_margin;
#endif
}

ivec2 cell_of_range(CellRange range, uint index) {
  uint columns = uint(range.high.x - range.low.x + 1);
  return range.low + ivec2(index % columns, index / columns);
}

// Fills tile_ends from the count of each thread's cell, and returns the total.
uint sum_counts(uint count, uint cells) {
  uint self = gl_LocalInvocationIndex;
  barrier();  // all have read the last ones
  tile_ends[self] = count;
  barrier();
  for (uint stride = 1u; stride < cells; stride *= 2u) {
    uint before = self >= stride ? tile_ends[self - stride] : 0u;
    barrier();
    tile_ends[self] += before;
    barrier();
  }
  return tile_ends[cells - 1u];
}

// Impact number `number` of the cells of the range from `first` on.
PlaneImpact numbered_impact(ImpactGrid grid, CellRange range, uint first, uint cells, uint number) {
#if PROCESS == STRATIFIED
  uint low = number;
  uint start = number;
#else
  uint low = 0u;
  uint high = cells - 1u;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (tile_ends[middle] > number) {
      high = middle;
    } else {
      low = middle + 1u;
    }
  }
  uint start = low == 0u ? 0u : tile_ends[low - 1u];
#endif
  ivec2 cell = cell_of_range(range, first + low);
  CellWords open = open_cell(grid, cell);
#ifdef CELL_STARTS
  open.next = tile_starts[low];
#endif
  skip_to_impact(grid, open, number - start);
  return impact_on_plane(grid, cell, next_impact(grid, open, number - start));
}

// Appends the impacts of the threads that keep theirs, in the order of threads, to a list of `listed` impacts. Returns
// how many it then has.
uint append_impacts(bool is_kept, PlaneImpact impact, uint listed) {
  uint word = gl_LocalInvocationIndex / 32u;
  uint bit = 1u << (gl_LocalInvocationIndex % 32u);
  if (gl_LocalInvocationIndex < group_size / 32u) tile_kept[gl_LocalInvocationIndex] = 0u;
  barrier();
  if (is_kept) atomicOr(tile_kept[word], bit);
  barrier();
  uint place = listed + uint(bitCount(tile_kept[word] & (bit - 1u)));
  for (uint i = 0u; i < group_size / 32u; ++i) {
    uint kept = uint(bitCount(tile_kept[i]));
    if (i < word) place += kept;
    listed += kept;
  }
  if (is_kept) {
    int sign_bit = impact.weight < 0.0 ? 1 << 24 : 0;
    tile_impacts[place] =
        ivec4(impact.place.coarse, impact.place.fine.x | impact.place.fine.y << 12 | sign_bit, impact.kernel);
  }
  barrier();
  return listed;
}

PlaneImpact listed_impact(uint i) {
  ivec4 impact = tile_impacts[i];
  PlanePoint place = PlanePoint(impact.xy, ivec2(impact.z & 4095, impact.z >> 12 & 4095));
  return PlaneImpact(place, impact.w, impact.z >> 24 != 0 ? -1.0 : 1.0);
}

void add_listed(PlanePoint point, KernelFilter kernel, uint listed, inout vec4 sums[GROUPS]) {
  for (uint i = 0u; i < listed; ++i) add_impact(point, kernel, listed_impact(i), sums);
}

// Lists the impacts in the box of a range of cells, and adds them whenever the list may not take all of a further step.
// Returns how many are left in it.
uint add_cells(ImpactGrid grid, CellRange range, PlaneBox box, PlanePoint point, KernelFilter kernel, uint listed,
               inout vec4 sums[GROUPS]) {
  uint all_cells = uint(range.high.x - range.low.x + 1) * uint(range.high.y - range.low.y + 1);
  for (uint first = 0u; first < all_cells; first += group_size) {
    uint cells = min(all_cells - first, group_size);
#if PROCESS == STRATIFIED
    uint total = cells;
#else
    uint count = 0u;
    if (gl_LocalInvocationIndex < cells) {
      CellWords open = open_cell(grid, cell_of_range(range, first + gl_LocalInvocationIndex));
      count = impact_count(grid, open);
#ifdef CELL_STARTS
      tile_starts[gl_LocalInvocationIndex] = open.next;
#endif
    }
    uint total = sum_counts(count, cells);
#endif
    for (uint start = 0u; start < total; start += group_size) {
      uint number = start + gl_LocalInvocationIndex;
      PlaneImpact impact = PlaneImpact(PlanePoint(ivec2(0), ivec2(0)), 0, 1.0);
      bool is_kept = number < total;
      if (is_kept) {
        impact = numbered_impact(grid, range, first, cells, number);
        is_kept = all(greaterThanEqual(impact.place.coarse, box.low)) &&
                  all(lessThanEqual(impact.place.coarse, box.high));
      }
      listed = append_impacts(is_kept, impact, listed);
      if (listed > list_size - group_size) {
        add_listed(point, kernel, listed, sums);
        listed = 0u;
      }
    }
  }
  return listed;
}

void add_impacts(PlanePoint point, mat2 footprint, PlaneBox tile, inout vec4 sums[GROUPS]) {
  KernelFilter kernel = kernel_filter(footprint);
  PlaneBox box = reaching(tile, margin_of_group(kernel.margin));
  ImpactGrid grid = recipe_grid();
  CellRange range = cells_of(grid, box);
  // So many rows that 32 bits count their cells.
  int rows = max((1 << 24) / (range.high.x - range.low.x + 1), 1);
  uint listed = 0u;
  for (int top = range.low.y; top <= range.high.y; top += rows) {
    ivec2 last = ivec2(range.high.x, min(top + rows - 1, range.high.y));
    listed = add_cells(grid, CellRange(ivec2(range.low.x, top), last), box, point, kernel, listed, sums);
  }
  add_listed(point, kernel, listed, sums);
  barrier();  // before the list of another sample of the same pixel
}
