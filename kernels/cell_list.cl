/* Kernels `empty_cells` and `fill_cells`: sort the grains of each replica into a grid of cells, one linked
   list per cell. The order within a list is random; the neighbour list is sorted when it is built. In large
   boxes the grid repeats: distant cells share a list, but the 27 cells around a grain are always distinct. */

INLINE int cell_along(real coordinate, real cell_size, int span) {
    return (int)fmin(fmax(floor(coordinate / cell_size), R(0)), (real)(span - 1));
}

INLINE int cell_index(global const Replica* restrict replica, int x, int y, int z) {
    return replica->first_cell +
           (z % replica->cells_z * replica->cells_y + y % replica->cells_y) * replica->cells_x +
           x % replica->cells_x;
}

INLINE int3 cell_of(global const Replica* restrict replica, real4 point) {
    if (replica->container >= CONTAINER_PERIODIC)
        point = (real4)(into_cell(point.x, replica->wall_position[1]),
                        into_cell(point.y, replica->wall_position[3]), point.z, point.w);
    if (replica->container == CONTAINER_CELL) point.z = into_cell(point.z, replica->wall_position[5]);
    return (int3)(cell_along(point.x, replica->cell_size[0], replica->span_x),
                  cell_along(point.y, replica->cell_size[1], replica->span_y),
                  cell_along(point.z, replica->cell_size[2], replica->span_z));
}

/* Range of cells along one axis that contains a cell and its neighbours, without duplicates. In periodic
   directions it may extend beyond the span; wrapped() maps such cells back. */
typedef struct {
    int first, last;
} CellRange;

INLINE CellRange near_cells(int cell, int span, bool repeats) {
    if (!repeats) return (CellRange){max(cell - 1, 0), min(cell + 1, span - 1)};
    return span < 3 ? (CellRange){0, span - 1} : (CellRange){cell - 1, cell + 1};
}

INLINE int wrapped(int cell, int span) { return cell < 0 ? cell + span : cell < span ? cell : cell - span; }

/* The cells of a box, by axis. */
typedef struct {
    CellRange x, y, z;
} CellBox;

/* The cell of a point and its neighbours. */
INLINE CellBox cells_around(global const Replica* restrict replica, real4 point) {
    const int3 cell = cell_of(replica, point);
    const bool repeats = replica->container >= CONTAINER_PERIODIC;
    return (CellBox){near_cells(cell.x, replica->span_x, repeats),
                     near_cells(cell.y, replica->span_y, repeats),
                     near_cells(cell.z, replica->span_z, replica->container == CONTAINER_CELL)};
}

INLINE CellRange joined_range(CellRange a, CellRange b) {
    return (CellRange){min(a.first, b.first), max(a.last, b.last)};
}
/* The smallest box that contains both. */
INLINE CellBox joined(CellBox a, CellBox b) {
    return (CellBox){joined_range(a.x, b.x), joined_range(a.y, b.y), joined_range(a.z, b.z)};
}

INLINE int width(CellRange range) { return range.last - range.first + 1; }
/* Whether the lists of a box's cells are distinct (they can repeat, see above) and not so many that its
   grains are compared faster one by one. */
#define MAX_CELLS 150
INLINE bool searchable(global const Replica* restrict replica, CellBox box) {
    return width(box.x) <= min(replica->cells_x, replica->span_x) &&
           width(box.y) <= min(replica->cells_y, replica->span_y) &&
           width(box.z) <= min(replica->cells_z, replica->span_z) &&
           width(box.x) * width(box.y) * width(box.z) <= MAX_CELLS;
}

/* The first of the `grains` grains of a work-item in kernels that build the lists, or -1 beyond the last
   block. The work-group size need not be BLOCK. */
INLINE int listed_grain(global const int* restrict blocks, int block_count, int grains) {
    const int place = get_global_id(0) * grains;
    return place < block_count * BLOCK ? blocks[place / BLOCK] * BLOCK + place % BLOCK : -1;
}
/* Work-group size of `list_neighbours`, whose work-items have LANES grains. */
#if LANES == 16
#define SEARCH_ITEMS 1
#else
#define SEARCH_ITEMS LIST_ITEMS
#endif

WORK_GROUP(LIST_ITEMS)
kernel void empty_cells(global const Replica* restrict replicas, global const Portion* restrict portions,
                        global int* restrict cell_head) {
    const Portion portion = portions[get_group_id(0)];
    global const Replica* restrict replica = replicas + portion.replica;
    const int groups = (replica->grain_count + PORTION_GRAINS - 1) / PORTION_GRAINS;
    const int cells = replica->cells_x * replica->cells_y * replica->cells_z;
    for (int c = portion.first / PORTION_GRAINS * LIST_ITEMS + get_local_id(0); c < cells;
         c += groups * LIST_ITEMS)
        cell_head[replica->first_cell + c] = -1;
}

WORK_GROUP(LIST_ITEMS)
kernel void fill_cells(const int block_count, global const Replica* restrict replicas,
                       global const int* restrict blocks, global const int* restrict replica_of_block,
                       global const Motion* restrict motion, global volatile int* restrict cell_head,
                       global int* restrict cell_next) {
    const int grain = listed_grain(blocks, block_count, 1);
    if (grain < 0) return;
    global const Replica* restrict replica = replicas + replica_of_block[grain / BLOCK];
    const real4 own = motion[grain].position;
    if (!(own.w > R(0))) return;
    const int3 place = cell_of(replica, own);
    const int cell = cell_index(replica, place.x, place.y, place.z);
    cell_next[grain] = atomic_xchg(cell_head + cell, grain);
}
