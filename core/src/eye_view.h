/* One view, before the sensor: luminance of every pixel, column after column. */
#ifndef LOBULA_EYE_VIEW_H
#define LOBULA_EYE_VIEW_H

#include <stddef.h>

#include "eye_paint.h"
#include "eye_surface.h"

/* A cylinder in view: the columns that it covers, and its greys under this light. */
typedef struct {
    eye_surface surface;
    const lobula_eye_cylinder *look;
    double left, right;
} eye_cylinder;

/* Memory that a view needs. */
typedef struct {
    eye_cylinder *cylinders; /* every body and obstacle */
    double *cuts;            /* where in the picture something begins or ends */
    eye_edge *edges;         /* of a column: the wall's, and those of all cylinders */
    float *piece, *part;     /* a column each */
} eye_scratch;

/* Cuts of one cylinder: both silhouettes, and a few inside each; and of the room. */
enum { EYE_CUTS = 8, EYE_ROOM_CUTS = 4 };

/* Edges of a column: of the room, and of a cylinder besides its bands. */
enum { EYE_ROOM_EDGES = 2, EYE_EDGES = 2 };

/* What differs from view to view. */
typedef struct {
    const double *camera, *poses;
    const uint8_t *shown, *obstacles; /* NULL: all */
    int64_t bodies, own;
    double light;
    int wall_pattern;
} eye_moment;

void eye_view(const lobula_eye_scene *scene, const lobula_eye_camera *camera, const eye_moment *moment,
              const eye_scratch *scratch, float *columns);

#endif
