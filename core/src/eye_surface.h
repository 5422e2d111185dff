/* What upright surfaces look like from a pupil: how near they are along a ray, and which part of their strip it meets.
 *
 * A ray leaves in the direction (1, s) of (forward, right); its depth counts along forward. The row of a level edge is
 * linear in the nearness, 1 / depth. */
#ifndef LOBULA_EYE_SURFACE_H
#define LOBULA_EYE_SURFACE_H

#include "lobula_eye.h"

/* The pupil and its axes, in the room. */
typedef struct {
    double x, y, heading, forward_x, forward_y, right_x, right_y;
} eye_pupil;

enum { EYE_PLANE, EYE_INSIDE, EYE_OUTSIDE };

/* A straight wall, or a round one seen from inside or from outside. */
typedef struct {
    int kind;
    const lobula_eye_strip *strip; /* NULL: plain */
    /* plane: nearness = near + near_slope s; place on the strip = start + (along + along_slope s) / nearness */
    double near, near_slope, start, along, along_slope;
    /* round: centre, its squared distance less the squared radius, the strip's zero against the pupil's axis */
    double forward, right, power, zero_rad, samples_per_rad;
} eye_surface;

/* Where a ray meets a surface: `place` is in samples of its strip, `sum` that of the strip up to there, `pace` goes as
 * the change of place with s. On a plain surface only the nearness counts. */
typedef struct {
    double nearness, place, sum, pace;
} eye_hit;

/* `strip` is the wall's, or NULL where its pattern is not wanted. */
eye_surface eye_plane_wall(const lobula_eye_scene *scene, const lobula_eye_strip *strip, const eye_pupil *pupil,
                           int side);
eye_surface eye_round_wall(const lobula_eye_scene *scene, const lobula_eye_strip *strip, const eye_pupil *pupil);
/* A cylinder at `pose` (x, y, heading). */
eye_surface eye_outside(const lobula_eye_cylinder *cylinder, const double *pose, const eye_pupil *pupil);

/* The rays that graze a cylinder on its left and right, infinite where it reaches past the pupil's side; 0: none of it
 * lies ahead. */
int eye_tangents(const eye_surface *round, double radius, double *left, double *right);

eye_hit eye_meet(const eye_surface *surface, double s);
/* The nearness of the far side of a cylinder. */
double eye_far_side(const eye_surface *round, double s);
/* Mean of the strip between two rays. */
double eye_strip_mean(const eye_surface *surface, double s0, double s1, eye_hit h0, eye_hit h1);
/* Mean of a whole strip. */
double eye_strip_grey(const lobula_eye_strip *strip);

#endif
