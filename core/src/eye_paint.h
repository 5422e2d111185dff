/* One column of the picture: level edges that run across it, and the greys between them. */
#ifndef LOBULA_EYE_PAINT_H
#define LOBULA_EYE_PAINT_H

/* Rows, counted down from the picture's upper rim, between which an edge runs straight across the column. */
typedef struct {
    double low, high;
} eye_edge;

static inline eye_edge eye_edge_between(double row0, double row1) {
    eye_edge e = {row0 < row1 ? row0 : row1, row0 < row1 ? row1 : row0};
    return e;
}

/* Paint `greys[k]` from edge k down to edge k + 1, of `count` edges from the top down; the last grey goes down to the
 * picture's lower rim. */
void eye_paint_ground(float *column, int height, const eye_edge *edges, const float *greys, int count);
/* The same for a body with nothing below its last edge: count - 1 greys. */
void eye_paint_body(float *column, int height, const eye_edge *edges, const float *greys, int count);

#endif
