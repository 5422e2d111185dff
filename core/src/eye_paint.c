#include "eye_paint.h"

#include <string.h>

static double middle(const eye_edge *e) { return e->low + e->high; }

void eye_stack_cover(eye_stack *stack, const eye_edge *body, int count) {
    double top = middle(&body[0]), rim = middle(&body[count - 1]);
    int first = 0, rest;
    while (first < stack->count && middle(&stack->edges[first]) < top) first++;
    for (rest = first; rest < stack->count && middle(&stack->edges[rest]) <= rim;) rest++;
    float beneath = rest ? stack->edges[rest - 1].grey : stack->above;
    memmove(stack->edges + first + count, stack->edges + rest, (size_t)(stack->count - rest) * sizeof *body);
    memcpy(stack->edges + first, body, (size_t)count * sizeof *body);
    stack->edges[first + count - 1].grey = beneath;
    stack->count += first + count - rest;
}

/* Integral from 0 to t of the share, at x, of an edge that spreads evenly over 0..d; times d. */
static double area(double t, double d) { return t <= 0 ? 0 : t < d ? 0.5 * t * t : d * (t - 0.5 * d); }

/* How much of row y lies below the edge. */
static double below(const eye_edge *e, int y) {
    double t = y - e->low, d = e->high - e->low;
    if (t <= 0 && e->high <= y + 1) return y + 1 - 0.5 * (e->low + e->high); /* all of it in this row, as most are */
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

/* Row y where several edges cross it: each brings in the change of grey that it makes, by the share of the row below. */
static float mixed(const eye_stack *stack, int y) {
    double grey = stack->above, above = stack->above;
    for (int k = 0; k < stack->count; k++) {
        double beneath = stack->edges[k].grey;
        grey += (beneath - above) * below(&stack->edges[k], y);
        above = beneath;
    }
    return (float)grey;
}

/* Rows that edge k and all after it leave alone end here. */
static int next_row(const eye_stack *stack, int k, int height) {
    int next = height;
    for (; k < stack->count; k++) {
        int first = first_row(&stack->edges[k], height);
        if (first < next) next = first;
    }
    return next;
}

void eye_paint(const eye_stack *stack, float *column, int height) {
    float above = stack->above;
    int y = 0, next = next_row(stack, 0, height);
    for (int k = 0; k < stack->count; k++) {
        const eye_edge *edge = &stack->edges[k];
        int clear = clear_row(edge, height);
        for (; y < next; y++) column[y] = above;
        next = next_row(stack, k + 1, height);
        for (; y < clear && y < next; y++) column[y] = above + (edge->grey - above) * (float)below(edge, y);
        for (; y < clear; y++) column[y] = mixed(stack, y);
        above = edge->grey;
    }
    for (; y < height; y++) column[y] = above;
}
