/* One column of the picture: level edges that run across it, one above the other, and the greys between them. */
#ifndef LOBULA_EYE_PAINT_H
#define LOBULA_EYE_PAINT_H

/* Rows, counted down from the picture's upper rim, between which an edge runs straight across the column, and the grey
 * below it. */
typedef struct {
    double low, high;
    float grey;
} eye_edge;

static inline eye_edge eye_edge_between(double row0, double row1, float grey) {
    eye_edge e = {row0 < row1 ? row0 : row1, row0 < row1 ? row1 : row0, grey};
    return e;
}

/* Edges from the top down, `above` being the grey over the first. */
typedef struct {
    eye_edge *edges;
    int count;
    float above;
} eye_stack;

/* Put a body before what the stack shows: `count` edges of it, the last being its lower rim, whose grey is not used. */
void eye_stack_cover(eye_stack *stack, const eye_edge *body, int count);

/* Every row of the column is the mean of what the stack shows there. */
void eye_paint(const eye_stack *stack, float *column, int height);

#endif
