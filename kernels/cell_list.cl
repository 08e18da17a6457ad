/* Which grains are in which cell: a linked list a cell. The order in a list is left to chance; the
   neighbour list sorts what it finds. */

INLINE int cell_along(real coordinate, real cell_size, int cells) {
    return clamp((int)floor(coordinate / cell_size), 0, cells - 1);
}

kernel void empty_cells(global const Replica* restrict replicas, global const int* restrict chosen,
                        global int* restrict cell_head) {
    global const Replica* restrict replica = replicas + chosen[get_group_id(0)];
    const int cells = replica->cells_x * replica->cells_y * replica->cells_z;
    for (int c = get_local_id(0); c < cells; c += get_local_size(0)) cell_head[replica->first_cell + c] = -1;
}

kernel void fill_cells(global const Replica* restrict replicas, global const int* restrict blocks,
                       global const int* restrict replica_of_block, global const real4* restrict position,
                       global volatile int* restrict cell_head, global int* restrict cell_next) {
    const int block = blocks[get_group_id(0)];
    const int grain = block * BLOCK + get_local_id(0);
    global const Replica* restrict replica = replicas + replica_of_block[block];
    const real4 own = position[grain];
    if (!(own.w > R(0))) return;
    const int x = cell_along(own.x, replica->cell_size, replica->cells_x);
    const int y = cell_along(own.y, replica->cell_size, replica->cells_y);
    const int z = cell_along(own.z, replica->cell_size, replica->cells_z);
    const int cell = replica->first_cell + (z * replica->cells_y + y) * replica->cells_x + x;
    cell_next[grain] = atomic_xchg(cell_head + cell, grain);
}
