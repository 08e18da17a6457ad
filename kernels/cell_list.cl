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

/* Replica and first of the `grains` grains of a work-item in kernels that build the lists; `first` is -1
   beyond the last block. `grains` divides BLOCK; the work-group size need not be BLOCK. */
INLINE Block listed_grains(global const Block* restrict blocks, int block_count, int grains) {
    const int place = get_global_id(0) * grains;
    if (place >= block_count * BLOCK) return (Block){0, -1};
    const Block block = blocks[place / BLOCK];
    return (Block){block.replica, block.first + place % BLOCK};
}

/* Linked lists of the grains in each cell. */
typedef struct {
    global const Motion* motion;
    global const int* head;
    global const int* next; /* per grain; -1: the last one */
} CellLists;

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
                       global const Block* restrict blocks, global const Motion* restrict motion,
                       global volatile int* restrict cell_head, global int* restrict cell_next) {
    const Block listed = listed_grains(blocks, block_count, 1);
    const int grain = listed.first;
    if (grain < 0) return;
    global const Replica* restrict replica = replicas + listed.replica;
    const real4 own = motion[grain].position;
    if (!(own.w > R(0))) return;
    const int3 place = cell_of(replica, own);
    const int cell = cell_index(replica, place.x, place.y, place.z);
    cell_next[grain] = atomic_xchg(cell_head + cell, grain);
}
