#include "eye_blur.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { MOST = 60 };

static int inside(int i, int n) { return i < 0 ? 0 : i >= n ? n - 1 : i; }

static void add(float *restrict to, const float *restrict from, float weight, int n) {
    for (int i = 0; i < n; i++) to[i] += weight * from[i];
}

/* The rows of one column; what a shift takes from beyond its ends is the end. */
static void blur_column(const float *from, float *to, int height, const float *weights, int radius) {
    memset(to, 0, (size_t)height * sizeof *to);
    for (int k = -radius; k <= radius; k++) {
        float weight = weights[k < 0 ? -k : k];
        int first = inside(-k, height + 1), end = inside(height - k, height + 1);
        for (int y = 0; y < first; y++) to[y] += weight * from[0];
        if (end > first) add(to + first, from + first + k, weight, end - first);
        for (int y = end; y < height; y++) to[y] += weight * from[height - 1];
    }
}

void eye_blur(float *columns, float *spare, int width, int height, double sd_px) {
    float weights[MOST + 1];
    double total = 0, exact[MOST + 1];
    int radius = (int)ceil(3 * sd_px);
    for (int k = 0; k <= radius; k++) {
        exact[k] = exp(-0.5 * (k / sd_px) * (k / sd_px));
        total += k ? 2 * exact[k] : exact[k];
    }
    for (int k = 0; k <= radius; k++) weights[k] = (float)(exact[k] / total);
    for (int x = 0; x < width; x++)
        blur_column(columns + (ptrdiff_t)x * height, spare + (ptrdiff_t)x * height, height, weights, radius);
    memset(columns, 0, (size_t)width * (size_t)height * sizeof *columns);
    for (int x = 0; x < width; x++)
        for (int k = -radius; k <= radius; k++)
            add(columns + (ptrdiff_t)x * height, spare + (ptrdiff_t)inside(x + k, width) * height,
                weights[k < 0 ? -k : k], height);
}
