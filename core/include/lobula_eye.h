/* The eye of the arena: what the camera on a small robot sees, for many robots in one call.
 *
 * A room with a striped wall, a plain floor, and upright cylinders: robots, and obstacles that stay where they are.
 * Every pixel is the mean luminance of what it covers, so that a tenth of a pixel of motion changes an edge of 50 grey
 * levels by 5. No heap, no globals, no threads; nothing is kept between calls. All results are the same on every
 * instruction set, and those of one view do not depend on the others.
 *
 * Lengths in cm, angles in radians, luminance 0..255. Positions are (x, y), y up, from the lower left corner of the room
 * (of the square around it, where it is round); headings count counter-clockwise from x. The camera looks level along
 * its heading, its axis meets the middle of the picture, pixels are square.
 */
#ifndef LOBULA_EYE_H
#define LOBULA_EYE_H

#include "lobula.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LOBULA_EYE_ABI 1          /* changes when anything in this file does */
#define LOBULA_EYE_NEAR_CM 0.01   /* a pupil nearer to a wall or to a cylinder, or inside it, is taken to be so far off */
#define LOBULA_EYE_MAX_BANDS 64
#define LOBULA_EYE_MAX_CYLINDERS 65536
#define LOBULA_EYE_MAX_LIGHT 1000.0
#define LOBULA_EYE_MAX_NOISE 100.0

/* Luminance along a closed line, in samples of equal length: `sums` holds samples + 1 running sums, sums[0] = 0. */
typedef struct {
    const double *sums;
    int32_t samples; /* 0: none, which reads as 0 */
    int32_t reserved;
} lobula_eye_strip;

typedef struct {
    double radius_cm, height_cm;
    const double *bands_grey; /* level bands of equal height, from the floor up; a low cylinder's top has their mean */
    int32_t bands, reserved;
    lobula_eye_strip around; /* added to the bands; counter-clockwise from the cylinder's heading */
} lobula_eye_cylinder;

enum { LOBULA_EYE_BOX, LOBULA_EYE_CIRCLE };

typedef struct {
    int32_t shape;
    int32_t obstacles;         /* cylinders that stay where they are */
    double width_cm, depth_cm; /* along x and y; of a circle both are its diameter */
    double wall_cm;            /* its height */
    double floor_grey, above_grey;
    lobula_eye_strip wall;    /* counter-clockwise from the lower left corner; in a circle from the point at heading 0 */
    lobula_eye_cylinder body; /* of every robot */
    const lobula_eye_cylinder *obstacle;
    const double *obstacle_poses; /* (obstacles, 3): x, y, heading */
} lobula_eye_scene;

typedef struct {
    int32_t width, height;
    double focal_px, ahead_cm, above_floor_cm; /* the pupil lies ahead of the robot's centre */
    double noise_grey, blur_px;                /* standard deviations */
} lobula_eye_camera;

/* What to draw. A pointer that may be NULL says so. */
typedef struct {
    int64_t count;            /* views */
    int64_t bodies;           /* robots in each */
    const double *cameras;    /* (count, 3): x and y of the robot's centre, heading */
    const double *poses;      /* (count, bodies, 3), or (bodies, 3) for all of them */
    int64_t poses_step;       /* doubles from one view's bodies to the next's: 3 bodies, or 0 */
    const int32_t *own;       /* (count): which body the camera sits on, never seen; -1 or NULL: none */
    const uint64_t *keys;     /* (count): the noise is a function of key and pixel; NULL: no noise */
    const double *light;      /* (count): gain on all luminance; NULL: 1 */
    const uint8_t *shown;     /* (count, bodies): 0 leaves a body out; NULL: all are there */
    const uint8_t *obstacles; /* (count, obstacles): the same for these */
    const uint8_t *walls;     /* (count): 0 paints the wall in its mean grey; NULL: as it is */
} lobula_eye_views;

LOBULA_API int lobula_eye_abi(void);

/* Bytes needed, for views with at most `bodies`; 0 where the scene or the camera cannot be. */
LOBULA_API size_t lobula_eye_workspace_size(const lobula_eye_scene *scene, const lobula_eye_camera *camera,
                                            int64_t bodies);

/* Draw all views to (count, height, width). `workspace` is aligned to LOBULA_ALIGN, and so large for these bodies. */
LOBULA_API int lobula_eye_draw(const lobula_eye_scene *scene, const lobula_eye_camera *camera,
                               const lobula_eye_views *views, void *workspace, int isa, uint8_t *out);

#ifdef __cplusplus
}
#endif
#endif
