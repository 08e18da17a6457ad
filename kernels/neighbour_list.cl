/* Kernels `list_neighbours` and `link_partner_slots`: build the neighbour lists. A grain's row contains all
   grains and walls within `probe_gap` + `skin`: first grains in order of index, then walls. The state stored
   per slot (surface displacements, springs, ..) moves with the neighbour to its new slot. */

#define SEARCH_ITEMS (LANES == 16 ? 1 : LIST_ITEMS) /* work-items with LANES grains in a work-group */

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
/* Whether the box's cells have distinct lists (cell_list.cl) and are so few that one search is faster than
   one per grain. */
#define MAX_SEARCHED_CELLS 150
INLINE bool searchable(global const Replica* restrict replica, CellBox box) {
    return width(box.x) <= min(replica->cells_x, replica->span_x) &&
           width(box.y) <= min(replica->cells_y, replica->span_y) &&
           width(box.z) <= min(replica->cells_z, replica->span_z) &&
           width(box.x) * width(box.y) * width(box.z) <= MAX_SEARCHED_CELLS;
}

/* Rows of a work-item's LANES grains while they are built. */
typedef struct {
    slots entry[SLOTS]; /* NO_ENTRY where empty, so that sorting puts empty slots last */
    slots count;        /* can exceed SLOTS: entries that do not fit are dropped, but counted */
} Rows;
#define NO_ENTRY 0x7fffffff

/* Inserts `entry` into the sorted rows of the lanes in `near`. */
INLINE void insert_sorted(Rows* rows, mask near, int entry) {
    slots moving = CHOOSE(BITS(near, -1), (slots)(entry), (slots)(NO_ENTRY));
    for (int c = 0; c < SLOTS; ++c) {
        const slots lower = min(rows->entry[c], moving);
        moving = max(rows->entry[c], moving);
        rows->entry[c] = lower;
    }
    rows->count += BITS(near, 1);
}

/* Vector between grains, from the difference of their stored positions: to the nearest image, deformed. */
INLINE lanes3 nearest_apart(global const Replica* restrict replica, Deformation f, lanes3 apart) {
    if (replica->container == CONTAINER_CELL)
        return deformed_lanes(f, nearest_lanes_in_cell(replica, f, apart));
    return replica->container == CONTAINER_PERIODIC ? nearest_between_sides(replica, apart) : apart;
}

/* Compares all grains in `box` with the lanes in `searching`. */
INLINE void search_cells(global const Replica* restrict replica, CellBox box, mask searching, slots grain,
                         lanes4 own, CellLists cells, Rows* rows) {
    const Deformation f = deformation(replica, R(0));
    const real margin = replica->probe_gap + replica->skin;
    for (int k = box.z.first; k <= box.z.last; ++k)
        for (int j = box.y.first; j <= box.y.last; ++j)
            for (int i = box.x.first; i <= box.x.last; ++i) {
                const int there = cell_index(replica, wrapped(i, replica->span_x),
                                             wrapped(j, replica->span_y), wrapped(k, replica->span_z));
                for (int other = cells.head[there]; other >= 0; other = cells.next[other]) {
                    const real4 position = cells.motion[other].position;
                    const lanes3 apart = nearest_apart(
                        replica, f, (lanes3){position.x - own.x, position.y - own.y, position.z - own.z});
                    const lanes within = (own.w + position.w) + margin; /* the same bits from both sides */
                    const mask near =
                        AS_MASK(dot3(apart, apart) < within * within) & searching & AS_MASK(grain != other);
                    if (ANY(near)) insert_sorted(rows, near, other);
                }
            }
}

/* Grains of a work-item that are close to each other search the box around all their cells together, if it is
   searchable(). */
INLINE void near_grains(global const Replica* restrict replica, int first, mask is_grain, lanes4 own,
                        CellLists cells, Rows* rows) {
    const slots grain = first + LANE_NUMBERS;
    int begin = 0;
    while (begin < LANES) {
        CellBox box = cells_around(replica, cells.motion[first + begin].position);
        int end = begin + 1;
        for (; end < LANES; ++end) {
            const real4 next = cells.motion[first + end].position;
            if (!(next.w > R(0))) continue;
            const CellBox both = joined(box, cells_around(replica, next));
            if (!searchable(replica, both)) break;
            box = both;
        }
        const mask searching = is_grain & AS_MASK(LANE_NUMBERS >= begin) & AS_MASK(LANE_NUMBERS < end);
        search_cells(replica, box, searching, grain, own, cells, rows);
        begin = end;
    }
}

INLINE void near_walls(global const Replica* restrict replica, mask is_grain, lanes4 own, Rows* rows) {
    if (replica->container == CONTAINER_CELL) return;
    const lanes3 centre = {own.x, own.y, own.z};
    const lanes reach = own.w + (replica->probe_gap + replica->skin);
    for (int w = 0; w < 6; ++w) {
        const lanes distance = w < 4    ? side_distance(replica, w, centre)
                               : w == 5 ? plate_distance(replica, replica->wall_position[5], centre)
                                        : own.z - replica->wall_position[4];
        const mask near = AS_MASK(distance < reach) & is_grain;
        if (!ANY(near)) continue;
        const slots at_end = CHOOSE(BITS(near, -1), rows->count, (slots)(SLOTS));
        for (int c = 0; c < SLOTS; ++c)
            rows->entry[c] = CHOOSE(at_end == c, (slots)(WALL_PARTNER(w)), rows->entry[c]);
        rows->count += BITS(near, 1);
    }
}

/* Reorders the stored values of a work-item's grains, which begin at `row`: each value follows its neighbour
   from slot `from` to its new slot; new neighbours (from < 0) start from zero. */
INLINE void carry(const slots* from, int count, global real* restrict values, size_t row) {
    lanes kept[SLOTS];
    for (int c = 0; c < count; ++c)
        kept[c] = gather(values + row, max(from[c], (slots)(0)) * LANES + LANE_NUMBERS);
    for (int c = 0; c < count; ++c)
        STORE_LANES(WHERE(AS_MASK(from[c] >= 0), kept[c], R(0)), values + SLOT_PLACE(row, c));
}

/* Replaces the stored rows, which are returned in `before`. Returns the number of slots in which a row has or
   had a neighbour, or 0 if no row has changed. */
INLINE int store_rows(const Rows* rows, global int* restrict partner, size_t row, slots* before) {
    slots changed = 0;
    int count = 0;
    for (int c = 0; c < SLOTS; ++c) {
        before[c] = LOAD_LANES(partner + SLOT_PLACE(row, c));
        const slots after = CHOOSE(rows->entry[c] == NO_ENTRY, (slots)(NO_PARTNER), rows->entry[c]);
        changed |= before[c] ^ after;
        if (ANY(AS_MASK((before[c] & after) != NO_PARTNER))) count = c + 1;
        STORE_LANES(after, partner + SLOT_PLACE(row, c));
    }
    return ANY(AS_MASK(changed != 0)) ? count : 0;
}

/* The slot in which each neighbour was before; -1 for a new one. */
INLINE void find_previous(const Rows* rows, const slots* before, int count, slots* from) {
    for (int c = 0; c < count; ++c) {
        from[c] = -1;
        for (int k = 0; k < count; ++k) from[c] = CHOOSE(before[k] == rows->entry[c], (slots)(k), from[c]);
    }
}

WORK_GROUP(SEARCH_ITEMS)
kernel void list_neighbours(const int block_count, global const Replica* restrict replicas,
                            global const Block* restrict blocks, global const Motion* restrict motion,
                            global const int* restrict cell_head, global const int* restrict cell_next,
                            global int* restrict partner, global real* restrict displacement,
                            global real* restrict history, global real* restrict memory,
                            global Track* restrict track, global int* restrict status) {
    const Block listed = listed_grains(blocks, block_count, LANES);
    const int first = listed.first;
    if (first < 0) return;
    global const Replica* restrict replica = replicas + listed.replica;
    const size_t row = FIRST_SLOT(first);
    const slots grain = first + LANE_NUMBERS;
    const lanes4 own = gather4((global const real4*)motion, grain * MOTION_VECTORS);
    scatter4(own, (global real4*)track, grain * TRACK_VECTORS);
    const mask is_grain = AS_MASK(own.w > R(0));
    if (!ANY(is_grain)) return;

    Rows rows;
    rows.count = 0;
    for (int c = 0; c < SLOTS; ++c) rows.entry[c] = NO_ENTRY;
    near_grains(replica, first, is_grain, own, (CellLists){motion, cell_head, cell_next}, &rows);
    near_walls(replica, is_grain, own, &rows);
    const mask full = AS_MASK(rows.count > SLOTS);
    if (ANY(full)) report_status(first, BITS(full, STATUS_SLOTS), status);

    slots before[SLOTS], from[SLOTS];
    const int count = store_rows(&rows, partner, row, before);
    const bool moves = replica->surface != SURFACE_RIGID;
    if (count == 0 || (!moves && replica->memory_rows == 0)) return;
    find_previous(&rows, before, count, from);
    if (moves) {
        carry(from, count, displacement, row);
        for (int turn = 0; turn < 4; ++turn)
            carry(from, count, history + (size_t)turn * replica->slot_count, row);
    }
    for (int kind = 0; kind < replica->memory_rows; ++kind)
        carry(from, count, memory + row * replica->memory_rows, (size_t)kind * SLOTS * LANES);
}

/* partner_slot: the slot of the same contact in the neighbour's row. For walls and empty slots it is
   `slot_count`, one element beyond all rows, where the displacement is always zero. */
WORK_GROUP(LIST_ITEMS)
kernel void link_partner_slots(const int block_count, const int slot_count,
                               global const Block* restrict blocks, global const int* restrict partner,
                               global int* restrict partner_slot) {
    const int grain = listed_grains(blocks, block_count, 1).first;
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
