#include "eye_paint.h"

/* Integral from 0 to t of the share, at x, of an edge that spreads evenly over 0..d; times d. */
static double area(double t, double d) { return t <= 0 ? 0 : t < d ? 0.5 * t * t : d * (t - 0.5 * d); }

/* How much of row y lies below the edge. */
static double below(const eye_edge *e, int y) {
    double t = y - e->low, d = e->high - e->low;
    if (d < 1e-6) return t + 1 < 0 ? 0 : t + 1 > 1 ? 1 : t + 1;
    return (area(t + 1, d) - area(t, d)) / d;
}

/* The first row that an edge touches, and the first one wholly below it. */
static int first_row(const eye_edge *e, int height) { return e->low <= 0 ? 0 : e->low >= height ? height : (int)e->low; }

static int clear_row(const eye_edge *e, int height) {
    if (e->high <= 0) return 0;
    if (e->high >= height) return height;
    return (int)e->high + (e->high > (int)e->high);
}

static void fill(float *column, int from, int to, float grey) {
    for (int y = from; y < to; y++) column[y] = grey;
}

/* What row y shows: every edge brings in the change of grey that it makes, by the share of the row below it. */
static float mixed(const eye_edge *edges, const float *greys, int count, int ground, float behind, int y) {
    double grey = behind, above = behind;
    for (int k = 0; k < count; k++) {
        double beneath = ground || k < count - 1 ? greys[k] : behind;
        grey += (beneath - above) * below(&edges[k], y);
        above = beneath;
    }
    return (float)grey;
}

static void paint(float *column, int height, const eye_edge *edges, const float *greys, int count, int ground) {
    int y = first_row(&edges[0], height);
    for (int k = 0; k < count; k++) {
        int clear = clear_row(&edges[k], height);
        for (; y < clear; y++) column[y] = mixed(edges, greys, count, ground, column[y], y);
        if (k == count - 1 && !ground) break;
        int next = k < count - 1 ? first_row(&edges[k + 1], height) : height;
        fill(column, y, next, greys[k]);
        if (next > y) y = next;
    }
}

void eye_paint_ground(float *column, int height, const eye_edge *edges, const float *greys, int count) {
    paint(column, height, edges, greys, count, 1);
}

void eye_paint_body(float *column, int height, const eye_edge *edges, const float *greys, int count) {
    paint(column, height, edges, greys, count, 0);
}
