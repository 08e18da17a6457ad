/* Kernels `list_neighbours` and `link_partner_slots`: build the neighbour lists. A grain's row contains all
   grains and walls within `probe_gap` + `skin`: first grains in order of index, then walls. The state stored
   per slot (surface displacements, springs, ..) moves with the neighbour to its new slot. */

/* Inserts `entry` into the sorted row. If the row is full, the entry is dropped, but counted. */
INLINE int insert_sorted(int* row, int count, int entry) {
    if (count < SLOTS) {
        int at = count;
        for (; at > 0 && row[at - 1] > entry; --at) row[at] = row[at - 1];
        row[at] = entry;
    }
    return count + 1;
}

INLINE int near_grains(global const Replica* restrict replica, int grain,
                       global const Motion* restrict motion, global const int* restrict cell_head,
                       global const int* restrict cell_next, int* row) {
    const real4 own = motion[grain].position;
    const real reach = replica->probe_gap + replica->skin;
    const int3 cell = cell_of(replica, own);
    const bool repeats = replica->container >= CONTAINER_PERIODIC,
               is_cell = replica->container == CONTAINER_CELL;
    const CellRange along_x = near_cells(cell.x, replica->span_x, repeats);
    const CellRange along_y = near_cells(cell.y, replica->span_y, repeats);
    const CellRange along_z = near_cells(cell.z, replica->span_z, is_cell);
    const real2 size = (real2)(replica->wall_position[1], replica->wall_position[3]),
                inverse_size = R(1) / size;
    const Deformation f = deformation(replica, R(0));
    int count = 0;
    for (int k = along_z.first; k <= along_z.last; ++k)
        for (int j = along_y.first; j <= along_y.last; ++j)
            for (int i = along_x.first; i <= along_x.last; ++i) {
                const int there = cell_index(replica, wrapped(i, replica->span_x),
                                             wrapped(j, replica->span_y), wrapped(k, replica->span_z));
                for (int other = cell_head[there]; other >= 0; other = cell_next[other]) {
                    if (other == grain) continue;
                    const real4 position = motion[other].position;
                    real3 apart = position.xyz - own.xyz;
                    if (is_cell)
                        apart = deformed(f, nearest_in_cell(replica, f, apart));
                    else if (repeats)
                        apart.xy -= size * WHOLE_NUMBER(apart.xy * inverse_size);
                    const real within = own.w + position.w + reach;
                    if (dot(apart, apart) < within * within) count = insert_sorted(row, count, other);
                }
            }
    return count;
}

INLINE int near_walls(global const Replica* restrict replica, real4 own, int* row, int count) {
    if (replica->container == CONTAINER_CELL) return count;
    const real reach = own.w + replica->probe_gap + replica->skin;
    for (int w = 0; w < 6; ++w) {
        const real wall = replica->wall_position[w];
        const bool leaning = w == 5 && (replica->effects & EFFECT_PLATE_TILT);
        const real distance = leaning  ? plate_distance(replica, wall, own)
                              : w < 4  ? side_distance(replica, w, own)
                              : w == 5 ? wall - own.z
                                       : own.z - wall;
        if (distance >= reach) continue;
        if (count < SLOTS) row[count] = WALL_PARTNER(w);
        ++count;
    }
    return count;
}

/* Reorders the stored values of a grain, which begin at `row`: each value follows its neighbour to the new
   slot; new neighbours start from zero. */
INLINE void carry(const int* before, const int* after, global real* restrict values, size_t row) {
    real kept[SLOTS];
    for (int c = 0; c < SLOTS; ++c) kept[c] = values[SLOT_PLACE(row, c)];
    for (int c = 0; c < SLOTS; ++c) {
        real value = R(0);
        for (int k = 0; k < SLOTS; ++k)
            if (after[c] != NO_PARTNER && before[k] == after[c]) value = kept[k];
        values[SLOT_PLACE(row, c)] = value;
    }
}

WORK_GROUP(LIST_ITEMS)
kernel void list_neighbours(const int block_count, const int slot_count,
                            global const Replica* restrict replicas, global const int* restrict blocks,
                            global const int* restrict replica_of_block, global const Motion* restrict motion,
                            global const int* restrict cell_head, global const int* restrict cell_next,
                            global int* restrict partner, global real* restrict displacement,
                            global real* restrict history, global real* restrict memory,
                            global Track* restrict track, global int* restrict status) {
    const int grain = listed_grain(blocks, block_count);
    if (grain < 0) return;
    global const Replica* restrict replica = replicas + replica_of_block[grain / BLOCK];
    const size_t row = FIRST_SLOT(grain);
    const real4 own = motion[grain].position;
    track[grain].listed_position = own;
    if (!(own.w > R(0))) return;

    int before[SLOTS], after[SLOTS];
    for (int c = 0; c < SLOTS; ++c) {
        before[c] = partner[SLOT_PLACE(row, c)];
        after[c] = NO_PARTNER;
    }
    int count = near_grains(replica, grain, motion, cell_head, cell_next, after);
    count = near_walls(replica, own, after, count);
    if (count > SLOTS) status[grain] |= STATUS_SLOTS;

    bool same = true;
    for (int c = 0; c < SLOTS; ++c) same = same && before[c] == after[c];
    if (same) return;
    for (int c = 0; c < SLOTS; ++c) partner[SLOT_PLACE(row, c)] = after[c];
    if (replica->surface != SURFACE_RIGID) {
        carry(before, after, displacement, row);
        for (int turn = 0; turn < 4; ++turn) carry(before, after, history + (size_t)turn * slot_count, row);
    }
    const size_t block = row - grain % LANES;
    for (int kind = 0; kind < replica->memory_rows; ++kind)
        carry(before, after, memory + block * replica->memory_rows, SLOT_PLACE(grain % LANES, kind * SLOTS));
}

/* partner_slot: the slot of the same contact in the neighbour's row. For walls and empty slots it is
   `slot_count`, one element beyond all rows, where the displacement is always zero. */
WORK_GROUP(LIST_ITEMS)
kernel void link_partner_slots(const int block_count, const int slot_count, global const int* restrict blocks,
                               global const int* restrict partner, global int* restrict partner_slot) {
    const int grain = listed_grain(blocks, block_count);
    if (grain < 0) return;
    const size_t row = FIRST_SLOT(grain);
    for (int c = 0; c < SLOTS; ++c) {
        const int other = partner[SLOT_PLACE(row, c)];
        int found = slot_count;
        if (other >= 0)
            for (int k = 0; k < SLOTS; ++k)
                if (partner[SLOT_PLACE(FIRST_SLOT(other), k)] == grain)
                    found = SLOT_PLACE(FIRST_SLOT(other), k);
        partner_slot[SLOT_PLACE(row, c)] = found;
    }
}
