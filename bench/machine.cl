/* Kernels that measure the limits of the machine: memory traffic, arithmetic, and the cost of a launch. */

kernel void triad(global float16* restrict a, global const float16* restrict b,
                  global const float16* restrict c, const float factor) {
    const size_t i = get_global_id(0);
    a[i] = b[i] + factor * c[i];
}

/* Twelve independent chains of multiply-adds, enough to fill the pipelines. A work-item executes
   FMA_ROUNDS * 12 multiply-adds of type `chain`: a vector on a CPU, one number on a GPU. */
kernel void multiply_add(global float* restrict out, const float factor, const float term) {
    const chain start = (chain)((float)get_global_id(0) * 1e-9f);
    chain x0 = start, x1 = start + 1.0f, x2 = start + 2.0f, x3 = start + 3.0f;
    chain x4 = start + 4.0f, x5 = start + 5.0f, x6 = start + 6.0f, x7 = start + 7.0f;
    chain x8 = start + 8.0f, x9 = start + 9.0f, xa = start + 10.0f, xb = start + 11.0f;
    const chain f = (chain)(factor), t = (chain)(term);
    for (int round = 0; round < FMA_ROUNDS; ++round) {
        x0 = fma(x0, f, t);
        x1 = fma(x1, f, t);
        x2 = fma(x2, f, t);
        x3 = fma(x3, f, t);
        x4 = fma(x4, f, t);
        x5 = fma(x5, f, t);
        x6 = fma(x6, f, t);
        x7 = fma(x7, f, t);
        x8 = fma(x8, f, t);
        x9 = fma(x9, f, t);
        xa = fma(xa, f, t);
        xb = fma(xb, f, t);
    }
    const chain sum = ((x0 + x1) + (x2 + x3)) + ((x4 + x5) + (x6 + x7)) + ((x8 + x9) + (xa + xb));
    out[get_global_id(0)] = FIRST_LANE(sum);
}

kernel void nothing(global float* restrict out) {
    if (get_global_id(0) == 0) out[0] = 1.0f;
}
