#include "eye_surface.h"

#include <math.h>

#define TWO_PI 6.283185307179586476925

/* Along a wall seen askew the strip passes at a growing pace; its plain mean would give the far part too much weight.
 * So a piece is cut until the pace within each part grows by no more than this. */
#define EVEN_PACE 1.06
#define MOST_CUTS 12

eye_surface eye_plane_wall(const lobula_eye_scene *scene, const lobula_eye_strip *strip, const eye_pupil *p, int side) {
    /* outward normal, gap to the wall, and the strip's way along it: lower, right, upper, left wall */
    static const double normals[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    double w = scene->width_cm, d = scene->depth_cm;
    const double gaps[4] = {p->y, w - p->x, d - p->y, p->x};
    const double starts[4] = {p->x, w + p->y, w + d + w - p->x, 2 * w + d + d - p->y};
    double nx = normals[side][0], ny = normals[side][1];
    double scale = (strip ? strip->samples : 0) / (2 * (w + d));
    eye_surface f = {.kind = EYE_PLANE, .strip = strip};
    f.near = (nx * p->forward_x + ny * p->forward_y) / gaps[side];
    f.near_slope = (nx * p->right_x + ny * p->right_y) / gaps[side];
    f.start = scale * starts[side];
    f.along = scale * (-ny * p->forward_x + nx * p->forward_y);
    f.along_slope = scale * (-ny * p->right_x + nx * p->right_y);
    return f;
}

static eye_surface round_surface(const lobula_eye_strip *strip, double x, double y, double zero_rad,
                                 const eye_pupil *p) {
    double dx = x - p->x, dy = y - p->y;
    eye_surface f = {.strip = strip, .zero_rad = p->heading - zero_rad};
    f.forward = dx * p->forward_x + dy * p->forward_y;
    f.right = dx * p->right_x + dy * p->right_y;
    f.samples_per_rad = strip ? strip->samples / TWO_PI : 0;
    return f;
}

eye_surface eye_round_wall(const lobula_eye_scene *scene, const lobula_eye_strip *strip, const eye_pupil *p) {
    double radius = 0.5 * scene->width_cm;
    eye_surface f = round_surface(strip, radius, radius, 0.0, p);
    f.kind = EYE_INSIDE;
    f.power = f.forward * f.forward + f.right * f.right - radius * radius;
    return f;
}

eye_surface eye_outside(const lobula_eye_cylinder *cylinder, const double *pose, const eye_pupil *p) {
    const lobula_eye_strip *strip = cylinder->around.samples ? &cylinder->around : NULL;
    eye_surface f = round_surface(strip, pose[0], pose[1], pose[2], p);
    double nearest = cylinder->radius_cm + LOBULA_EYE_NEAR_CM;
    double distance = sqrt(f.forward * f.forward + f.right * f.right);
    f.kind = EYE_OUTSIDE;
    if (distance < nearest) { /* a pupil inside it: moved straight back out of it */
        f.forward = distance > 0 ? f.forward * (nearest / distance) : nearest;
        f.right = distance > 0 ? f.right * (nearest / distance) : 0.0;
        distance = nearest;
    }
    f.power = (distance - cylinder->radius_cm) * (distance + cylinder->radius_cm);
    return f;
}

/* tan(a -+ b), a the angle of the centre to the right of the axis, b half the angle that the cylinder fills. */
int eye_tangents(const eye_surface *f, double radius, double *left, double *right) {
    double tangent = sqrt(f->power);
    double left_ahead = f->forward * tangent + f->right * radius;
    double right_ahead = f->forward * tangent - f->right * radius;
    if (left_ahead <= 0 && right_ahead <= 0) return 0;
    *left = left_ahead > 0 ? (f->right * tangent - f->forward * radius) / left_ahead : -INFINITY;
    *right = right_ahead > 0 ? (f->right * tangent + f->forward * radius) / right_ahead : INFINITY;
    return 1;
}

/* Depth z of the ray solves (1 + s s) z z - 2 b z + power = 0; the root of the discriminant, and b. */
static double root_of(const eye_surface *f, double s, double *b) {
    *b = f->forward + s * f->right;
    double square = *b * *b - (1 + s * s) * f->power;
    return square > 0 ? sqrt(square) : 0.0;
}

static double sum_to(const lobula_eye_strip *strip, double place) {
    double rounds = 0.0;
    if (!(place >= 0 && place < strip->samples)) {
        rounds = floor(place / strip->samples);
        place -= rounds * strip->samples;
    }
    int i = (int)place;
    if (i > strip->samples - 1) i = strip->samples - 1;
    const double *sums = strip->sums + i;
    return rounds * strip->sums[strip->samples] + sums[0] + (place - i) * (sums[1] - sums[0]);
}

static inline eye_hit meet_plane(const eye_surface *f, double s) {
    eye_hit hit = {.nearness = f->near + f->near_slope * s};
    if (f->strip) {
        double depth = 1 / hit.nearness;
        hit.place = f->start + (f->along + f->along_slope * s) * depth;
        hit.pace = depth * depth;
        hit.sum = sum_to(f->strip, hit.place);
    }
    return hit;
}

static inline eye_hit meet_round(const eye_surface *f, double s) {
    double b, root = root_of(f, s, &b);
    eye_hit hit = {0};
    /* the root that does not cancel */
    if (f->kind == EYE_OUTSIDE)
        hit.nearness = (b + root) / f->power;
    else
        hit.nearness = b < 0 ? (b - root) / f->power : (1 + s * s) / (b + root);
    if (f->strip) {
        double depth = 1 / hit.nearness;
        double angle = f->zero_rad - atan2(depth * s - f->right, depth - f->forward);
        hit.place = angle * f->samples_per_rad;
        hit.pace = depth / (root + 1e-6 * depth); /* finite where a ray grazes */
        hit.sum = sum_to(f->strip, hit.place);
    }
    return hit;
}

eye_hit eye_meet(const eye_surface *f, double s) { return f->kind == EYE_PLANE ? meet_plane(f, s) : meet_round(f, s); }

double eye_far_side(const eye_surface *f, double s) {
    double b, root = root_of(f, s, &b);
    double nearness = (1 + s * s) / (b + root);
    return nearness > 0 ? nearness : 0.0;
}

static double mean_between(const lobula_eye_strip *strip, eye_hit a, eye_hit b) {
    double length = b.place - a.place, sum = b.sum - a.sum, half = 0.5 * strip->samples;
    if (fabs(length) > half) { /* a round wall's places jump by a turn somewhere */
        double turn = length > 0 ? 1 : -1;
        length -= turn * strip->samples;
        sum -= turn * strip->sums[strip->samples];
    }
    if (fabs(length) > 1e-6) return sum / length;
    return (sum_to(strip, a.place + 1e-6) - a.sum) / 1e-6;
}

double eye_strip_mean(const eye_surface *f, double s0, double s1, eye_hit h0, eye_hit h1) {
    double low = h0.pace < h1.pace ? h0.pace : h1.pace, high = h0.pace < h1.pace ? h1.pace : h0.pace;
    if (high < EVEN_PACE * low) return mean_between(f->strip, h0, h1);
    double wanted = 1 + (high / low - 1) / (EVEN_PACE - 1), sum = 0.0;
    int cuts = wanted < MOST_CUTS ? (int)wanted : MOST_CUTS;
    eye_hit before = h0;
    for (int i = 1; i <= cuts; i++) {
        eye_hit after = i < cuts ? eye_meet(f, s0 + (s1 - s0) * i / cuts) : h1;
        sum += mean_between(f->strip, before, after);
        before = after;
    }
    return sum / cuts;
}

double eye_strip_grey(const lobula_eye_strip *strip) {
    return strip->samples > 0 ? strip->sums[strip->samples] / strip->samples : 0.0;
}
