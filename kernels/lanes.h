/* Vector types and operations that hide the difference between the CPU and the GPU layout.
   `lanes` has one number for each grain of a work-item: LANES = 16 grains on a CPU (a vector), one on a GPU.
   WHERE(condition, yes, no) selects numbers lane by lane, CHOOSE indices. A grain has SLOTS slots. A CPU's
   work-item processes all of them, a GPU's only one in the kernels of a step: arrays over slots have
   SLOTS_HERE entries, and entry v belongs to slot SLOT(v). The slots of a grain exchange data in EXCHANGE
   arrays: private memory on a CPU, local memory on a GPU. */
#if LANES == 16
#if MCDEM_DOUBLE
typedef double16 lanes;
typedef long16 mask;
#define AS_MASK(integers) convert_long16(integers)
#else
typedef float16 lanes;
typedef int16 mask;
#define AS_MASK(integers) (integers)
#endif
typedef int16 slots;
#define AS_SLOTS(numbers) convert_int16(numbers)
#define WHERE(condition, yes, no) select((lanes)(no), (lanes)(yes), (condition))
#define CHOOSE(condition, yes, no) select((slots)(no), (slots)(yes), (condition))
#define BITS(condition, bits) (convert_int16(condition) & (bits))
#define NOT(condition) (~(condition))
#define ANY(m) any_lane(m)
#define LANE_NUMBERS ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define SLOTS_HERE SLOTS
#define SLOT(v) (v)
#define EXCHANGE private
#define SYNCHRONISE()
#define LOAD_LANES(field) vload16(0, field)
#define STORE_LANES(value, field) vstore16(value, 0, field)
#else
typedef real lanes;
typedef int mask;
typedef int slots;
#define AS_MASK(integers) (integers)
#define AS_SLOTS(numbers) ((int)(numbers))
#define WHERE(condition, yes, no) ((condition) ? (lanes)(yes) : (lanes)(no))
#define CHOOSE(condition, yes, no) ((condition) ? (slots)(yes) : (slots)(no))
#define BITS(condition, bits) ((condition) ? (bits) : 0)
#define NOT(condition) (!(condition))
#define ANY(m) (m)
#define LANE_NUMBERS 0
#define SLOTS_HERE 1
#define SLOT(v) ((int)(get_local_id(0) % SLOTS))
#define EXCHANGE local
#define SYNCHRONISE() barrier(CLK_LOCAL_MEM_FENCE)
#define LOAD_LANES(field) (*(field))
#define STORE_LANES(value, field) (*(field) = (value))
#endif

typedef struct {
    lanes x, y, z;
} lanes3;
typedef struct {
    lanes x, y, z, w;
} lanes4;

INLINE lanes3 add3(lanes3 a, lanes3 b) { return (lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
INLINE lanes3 subtract3(lanes3 a, lanes3 b) { return (lanes3){a.x - b.x, a.y - b.y, a.z - b.z}; }
INLINE lanes3 scale3(lanes factor, lanes3 a) { return (lanes3){factor * a.x, factor * a.y, factor * a.z}; }
/* a + factor b in one expression, so that compilers may use fused multiply-add. */
INLINE lanes3 add_scaled3(lanes3 a, lanes factor, lanes3 b) {
    return (lanes3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
/* a + b without fused multiply-add. If a and b are products that belong to the two sides of a contact, fusing
   would round only one of them, and the two sides would get different bits. NVIDIA's compiler fuses in spite
   of the pragma, but not an addition that states its rounding. */
INLINE lanes add_alike(lanes a, lanes b) {
#pragma OPENCL FP_CONTRACT OFF
#if LANES == 1 && defined(__NV_CL_C_VERSION)
    lanes sum;
#if MCDEM_DOUBLE
    __asm__("add.rn.f64 %0, %1, %2;" : "=d"(sum) : "d"(a), "d"(b));
#else
    __asm__("add.rn.f32 %0, %1, %2;" : "=f"(sum) : "f"(a), "f"(b));
#endif
    return sum;
#else
    return a + b;
#endif
}
INLINE lanes dot3(lanes3 a, lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE lanes3 cross3(lanes3 a, lanes3 b) {
    return (lanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
INLINE lanes3 where3(mask condition, lanes3 yes, lanes3 no) {
    return (lanes3){WHERE(condition, yes.x, no.x), WHERE(condition, yes.y, no.y),
                    WHERE(condition, yes.z, no.z)};
}
#define ZERO3 ((lanes3){R(0), R(0), R(0)})

#if LANES == 16
/* Replaces any(), which branches on every lane in PoCL. */
INLINE bool any_lane(mask m) {
#if MCDEM_DOUBLE
    const long8 eight = m.lo | m.hi;
    const long4 four = eight.lo | eight.hi;
    const long2 two = four.lo | four.hi;
#else
    const int8 eight = m.lo | m.hi;
    const int4 four = eight.lo | eight.hi;
    const int2 two = four.lo | four.hi;
#endif
    return (two.x | two.y) != 0;
}

/* Optimisation barrier without instructions. Without it LLVM splits the vectors of a transposition into loads
   of single numbers, which doubles the number of instructions. */
#if defined(__AVX512F__) && !MCDEM_DOUBLE
#define KEEP_WHOLE(type, vector) __asm__("" : "+v"(vector))
#elif defined(__AVX__) && !MCDEM_DOUBLE
#define KEEP_WHOLE(type, vector)                       \
    do {                                               \
        type##8 low = (vector).lo, high = (vector).hi; \
        __asm__("" : "+x"(low), "+x"(high));           \
        (vector) = (type##16)(low, high);              \
    } while (false)
#else
#define KEEP_WHOLE(type, vector)
#endif

/* Transposition between 16 rows of four numbers and four vectors of 16. Each intermediate vector contains
   rows i, i + 4, i + 8 and i + 12, so two rounds of interleaving within 128-bit parts give the lanes in
   order. */
#define INTERLEAVE_LOW(a, b) \
    __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define INTERLEAVE_HIGH(a, b) \
    __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define LOW_PAIRS(a, b) \
    __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define HIGH_PAIRS(a, b) \
    __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
#define FOUR_ROWS(type, field, place, i) \
    (type##16)((field)[place(i)], (field)[place(i + 4)], (field)[place(i + 8)], (field)[place(i + 12)])
/* Vector q of `out` contains number q of the rows at place(0) to place(15). */
#define TRANSPOSE_ROWS(type, field, place, out)                                              \
    do {                                                                                     \
        type##16 a = FOUR_ROWS(type, field, place, 0), b = FOUR_ROWS(type, field, place, 1); \
        type##16 c = FOUR_ROWS(type, field, place, 2), d = FOUR_ROWS(type, field, place, 3); \
        KEEP_WHOLE(type, a);                                                                 \
        KEEP_WHOLE(type, b);                                                                 \
        KEEP_WHOLE(type, c);                                                                 \
        KEEP_WHOLE(type, d);                                                                 \
        const type##16 ab_low = INTERLEAVE_LOW(a, b), ab_high = INTERLEAVE_HIGH(a, b);       \
        const type##16 cd_low = INTERLEAVE_LOW(c, d), cd_high = INTERLEAVE_HIGH(c, d);       \
        (out)[0] = LOW_PAIRS(ab_low, cd_low), (out)[1] = HIGH_PAIRS(ab_low, cd_low);         \
        (out)[2] = LOW_PAIRS(ab_high, cd_high), (out)[3] = HIGH_PAIRS(ab_high, cd_high);     \
    } while (false)

/* Indices of the lanes in memory, where scalar code reads them faster than out of a vector. vstore16() stores
   them in parts; scalar loads wait longer for a single store of the whole vector. */
typedef struct {
    int lane[LANES];
} Places;
INLINE void store_places(slots index, Places* restrict places) {
    vstore16(index, 0, places->lane);
#if defined(__AVX__)
    __asm__("" : "+m"(*places)); /* otherwise LLVM reads them from the vector */
#endif
}

#define STORED_PLACE(i) (places->lane[i])

INLINE lanes4 gather4_at(global const real4* restrict field, const Places* restrict places) {
    lanes out[4];
    TRANSPOSE_ROWS(real, field, STORED_PLACE, out);
    return (lanes4){out[0], out[1], out[2], out[3]};
}
INLINE lanes4 gather4(global const real4* restrict field, slots index) {
    Places places;
    store_places(index, &places);
    return gather4_at(field, &places);
}

/* field[place(i)] = number i of the four vectors */
#define SCATTER_ROWS(v, field, place)                                                       \
    do {                                                                                    \
        const lanes xy_low = INTERLEAVE_LOW(v.x, v.y), xy_high = INTERLEAVE_HIGH(v.x, v.y); \
        const lanes zw_low = INTERLEAVE_LOW(v.z, v.w), zw_high = INTERLEAVE_HIGH(v.z, v.w); \
        SCATTER_FOUR(LOW_PAIRS(xy_low, zw_low), field, place, 0);                           \
        SCATTER_FOUR(HIGH_PAIRS(xy_low, zw_low), field, place, 1);                          \
        SCATTER_FOUR(LOW_PAIRS(xy_high, zw_high), field, place, 2);                         \
        SCATTER_FOUR(HIGH_PAIRS(xy_high, zw_high), field, place, 3);                        \
    } while (false)
#define SCATTER_FOUR(rows, field, place, i)                                \
    do {                                                                   \
        const lanes r = rows;                                              \
        (field)[place(i)] = r.s0123, (field)[place(i + 4)] = r.s4567;      \
        (field)[place(i + 8)] = r.s89ab, (field)[place(i + 12)] = r.scdef; \
    } while (false)
INLINE void scatter4(lanes4 v, global real4* restrict field, slots index) {
    Places stored;
    const Places* places = &stored;
    store_places(index, &stored);
    SCATTER_ROWS(v, field, STORED_PLACE);
}

/* field[index], lane by lane */
INLINE lanes gather(global const real* restrict field, slots index) {
    return (lanes)(field[index.s0], field[index.s1], field[index.s2], field[index.s3], field[index.s4],
                   field[index.s5], field[index.s6], field[index.s7], field[index.s8], field[index.s9],
                   field[index.sa], field[index.sb], field[index.sc], field[index.sd], field[index.se],
                   field[index.sf]);
}

#else
typedef int Places;
INLINE void store_places(slots index, Places* restrict places) { *places = index; }
INLINE lanes4 gather4_at(global const real4* restrict field, const Places* restrict places) {
    const real4 f = field[*places];
    return (lanes4){f.x, f.y, f.z, f.w};
}
INLINE lanes4 gather4(global const real4* restrict field, slots index) { return gather4_at(field, &index); }
INLINE void scatter4(lanes4 value, global real4* restrict field, slots index) {
    field[index] = (real4)(value.x, value.y, value.z, value.w);
}
INLINE lanes gather(global const real* restrict field, slots index) { return field[index]; }
#endif

/* Fields with one number per slot: the LANES grains of a work-item are side by side, slot by slot. A slot
   begins at SLOT_PLACE(row, v), where `row` is that of the work-item's first grain, FIRST_SLOT(first). */
#define FIRST_SLOT(grain) ((size_t)((grain) / LANES) * (LANES * SLOTS) + (size_t)((grain) % LANES))
#define SLOT_PLACE(row, c) ((row) + (size_t)(c)*LANES)
INLINE lanes load_slot(global const real* restrict field, size_t row, int v) {
    return LOAD_LANES(field + SLOT_PLACE(row, SLOT(v)));
}
INLINE slots load_number(global const int* restrict field, size_t row, int v) {
    return LOAD_LANES(field + SLOT_PLACE(row, SLOT(v)));
}
INLINE void store_slot(lanes value, global real* restrict field, size_t row, int v) {
    STORE_LANES(value, field + SLOT_PLACE(row, SLOT(v)));
}

/* 1 / sqrt(x). In float on x86 the processor's estimate is refined by one Newton step, with a relative error
   below 3e-7, with AVX-512 below 1.5e-7. Root and division would occupy the divider for most of the loop over
   pairs of contacts. */
INLINE lanes inverse_root(lanes x) {
#if LANES == 16 && defined(__AVX__) && !MCDEM_DOUBLE
#if defined(__AVX512F__)
    lanes estimate;
    __asm__("vrsqrt14ps %1, %0" : "=v"(estimate) : "v"(x));
#else
    real8 low, high;
    __asm__("vrsqrtps %1, %0" : "=x"(low) : "x"(x.lo));
    __asm__("vrsqrtps %1, %0" : "=x"(high) : "x"(x.hi));
    const lanes estimate = (lanes)(low, high);
#endif
    return estimate * (R(1.5) - R(0.5) * x * (estimate * estimate));
#else
    return R(1) / sqrt(x);
#endif
}
