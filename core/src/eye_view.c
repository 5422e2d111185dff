#include "eye_view.h"

#include <math.h>
#include <string.h>

/* Near its silhouette a cylinder's edges bend like a root; they are cut where the root is 1/4, 1/2 and 3/4, unless
 * they fall by less than this many rows over the first pixel. */
#define BENT_ROWS 0.05

/* Where an edge of the wall falls by more rows than this within a column, a stripe that ends there meets it higher or
 * lower than the column's mean says: the column is cut. */
#define STEEP_ROWS 1.0
#define MOST_PARTS 8

typedef struct {
    const lobula_eye_scene *scene;
    const lobula_eye_camera *camera;
    double middle_x, middle_y, per_px;
    float light;
    eye_pupil pupil;
    eye_surface wall[4];
    const lobula_eye_strip *strip; /* of the wall; NULL: plain */
    double wall_grey;
    int walls, cylinders, cuts;
    /* where the ray at `met_s` met the wall `met`: a piece begins where the one before it ended */
    const eye_surface *met;
    double met_s;
    eye_hit met_hit;
} eye_state;

static double ray_at(const eye_state *e, double u) { return (u - e->middle_x) * e->per_px; }

static double column_of(const eye_state *e, double s) { return e->middle_x + s * e->camera->focal_px; }

/* The row of a point `height_cm` over the floor. */
static double row_of(const eye_state *e, double height_cm, double nearness) {
    return e->middle_y + e->camera->focal_px * (e->camera->above_floor_cm - height_cm) * nearness;
}

static float lit(const eye_state *e, double grey) {
    return (float)(grey < 0 ? 0 : grey > 255 ? 255 : grey) * e->light;
}

static double within(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static eye_pupil pupil_at(const lobula_eye_scene *scene, const double *camera, double ahead) {
    eye_pupil p = {.heading = camera[2], .forward_x = cos(camera[2]), .forward_y = sin(camera[2])};
    p.right_x = p.forward_y;
    p.right_y = -p.forward_x;
    p.x = camera[0] + ahead * p.forward_x;
    p.y = camera[1] + ahead * p.forward_y;
    if (scene->shape == LOBULA_EYE_BOX) {
        p.x = within(p.x, LOBULA_EYE_NEAR_CM, scene->width_cm - LOBULA_EYE_NEAR_CM);
        p.y = within(p.y, LOBULA_EYE_NEAR_CM, scene->depth_cm - LOBULA_EYE_NEAR_CM);
    } else {
        double radius = 0.5 * scene->width_cm, dx = p.x - radius, dy = p.y - radius;
        double distance = sqrt(dx * dx + dy * dy), most = radius - LOBULA_EYE_NEAR_CM;
        if (distance > most) {
            p.x = radius + dx * (most / distance);
            p.y = radius + dy * (most / distance);
        }
    }
    return p;
}

static void add_cut(eye_state *e, double *cuts, double u) {
    if (!(u > 0 && u < e->camera->width)) return;
    int i = e->cuts++;
    for (; i > 0 && cuts[i - 1] > u; i--) cuts[i] = cuts[i - 1];
    cuts[i] = u;
}

static void set_walls(eye_state *e, double *cuts) {
    const lobula_eye_scene *scene = e->scene;
    if (scene->shape == LOBULA_EYE_CIRCLE) {
        e->walls = 1;
        e->wall[0] = eye_round_wall(scene, e->strip, &e->pupil);
        return;
    }
    e->walls = 4;
    for (int i = 0; i < 4; i++) {
        double dx = (i & 1 ? scene->width_cm : 0) - e->pupil.x, dy = (i & 2 ? scene->depth_cm : 0) - e->pupil.y;
        double forward = dx * e->pupil.forward_x + dy * e->pupil.forward_y;
        double right = dx * e->pupil.right_x + dy * e->pupil.right_y;
        e->wall[i] = eye_plane_wall(scene, e->strip, &e->pupil, i);
        if (forward > 0) add_cut(e, cuts, column_of(e, right / forward));
    }
}

static double bend_rows(const eye_state *e, const eye_cylinder *c, double s) {
    double step = 1 / e->camera->focal_px, above = fabs(c->look->height_cm - e->camera->above_floor_cm);
    double reach = above > e->camera->above_floor_cm ? above : e->camera->above_floor_cm;
    double inner = eye_meet(&c->surface, s + (s < 0.5 * (c->left + c->right) ? step : -step)).nearness;
    return e->camera->focal_px * reach * (inner - eye_meet(&c->surface, s).nearness);
}

static void add_silhouette(eye_state *e, const eye_cylinder *c, double s, double inward, double *cuts) {
    static const double roots[3] = {1.0 / 16, 1.0 / 4, 9.0 / 16};
    double u = column_of(e, s);
    if (!(u > -1 && u < e->camera->width + 1)) return;
    add_cut(e, cuts, u);
    if (bend_rows(e, c, s) < BENT_ROWS) return;
    for (int i = 0; i < 3; i++) add_cut(e, cuts, u + inward * roots[i]);
}

/* The farthest first. Of two cylinders on one ray that do not overlap, the nearer has the smaller power. */
static void add_cylinder(eye_state *e, const lobula_eye_cylinder *look, const double *pose, const eye_scratch *k) {
    eye_cylinder c = {.surface = eye_outside(look, pose, &e->pupil), .look = look};
    double last = 0.5 * e->camera->width / e->camera->focal_px;
    if (!eye_tangents(&c.surface, look->radius_cm, &c.left, &c.right) || c.right <= -last || c.left >= last) return;
    int i = e->cylinders++;
    for (; i > 0 && k->cylinders[i - 1].surface.power < c.surface.power; i--) k->cylinders[i] = k->cylinders[i - 1];
    k->cylinders[i] = c;
    add_silhouette(e, &c, c.left, 1, k->cuts);
    add_silhouette(e, &c, c.right, -1, k->cuts);
}

static const eye_surface *wall_at(const eye_state *e, double s) {
    int nearest = 0;
    double best = 0;
    for (int i = 0; i < e->walls && e->walls > 1; i++) {
        double nearness = e->wall[i].near + e->wall[i].near_slope * s;
        if (nearness > best) {
            best = nearness;
            nearest = i;
        }
    }
    return &e->wall[nearest];
}

static eye_edge edge_of(const eye_state *e, double height_cm, double nearness0, double nearness1, double grey) {
    return eye_edge_between(row_of(e, height_cm, nearness0), row_of(e, height_cm, nearness1), lit(e, grey));
}

static void start_with_room(eye_state *e, double s0, double s1, eye_stack *stack) {
    const lobula_eye_scene *scene = e->scene;
    const eye_surface *wall = wall_at(e, 0.5 * (s0 + s1));
    eye_hit h0 = e->met == wall && e->met_s == s0 ? e->met_hit : eye_meet(wall, s0), h1 = eye_meet(wall, s1);
    double grey = e->strip ? eye_strip_mean(wall, s0, s1, h0, h1) : e->wall_grey;
    stack->above = lit(e, scene->above_grey);
    stack->edges[0] = edge_of(e, scene->wall_cm, h0.nearness, h1.nearness, grey);
    stack->edges[1] = edge_of(e, 0, h0.nearness, h1.nearness, scene->floor_grey);
    stack->count = EYE_ROOM_EDGES;
    e->met = wall;
    e->met_s = s1;
    e->met_hit = h1;
}

static double mean_of_bands(const lobula_eye_cylinder *look) {
    double sum = 0;
    for (int k = 0; k < look->bands; k++) sum += look->bands_grey[k];
    return sum / look->bands;
}

static void cover_with_cylinder(const eye_state *e, const eye_cylinder *c, double s0, double s1, eye_stack *stack) {
    const lobula_eye_cylinder *look = c->look;
    eye_edge edges[LOBULA_EYE_MAX_BANDS + 2];
    eye_hit h0 = eye_meet(&c->surface, s0), h1 = eye_meet(&c->surface, s1);
    double around = c->surface.strip ? eye_strip_mean(&c->surface, s0, s1, h0, h1) : 0;
    int count = 0;
    if (look->height_cm < e->camera->above_floor_cm) /* its top is seen from above */
        edges[count++] = edge_of(e, look->height_cm, eye_far_side(&c->surface, s0), eye_far_side(&c->surface, s1),
                                 mean_of_bands(look) + eye_strip_grey(&look->around));
    for (int k = look->bands; k > 0; k--)
        edges[count++] = edge_of(e, look->height_cm * k / look->bands, h0.nearness, h1.nearness,
                                 look->bands_grey[k - 1] + around);
    edges[count++] = edge_of(e, 0, h0.nearness, h1.nearness, 0);
    eye_stack_cover(stack, edges, count);
}

static void finish(const eye_state *e, const eye_scratch *k, double s0, double s1, eye_stack *stack, float *column) {
    double middle = 0.5 * (s0 + s1);
    for (int i = 0; i < e->cylinders; i++) {
        const eye_cylinder *c = &k->cylinders[i];
        if (c->left < middle && middle < c->right) cover_with_cylinder(e, c, s0, s1, stack);
    }
    eye_paint(stack, column, e->camera->height);
}

static void add(float *restrict to, const float *restrict from, float share, int height) {
    for (int y = 0; y < height; y++) to[y] += share * from[y];
}

/* Into how many parts the wall's edges, where they are in the picture, and its stripes must be cut. */
static int parts_of(const eye_state *e, const eye_stack *room) {
    double most = 0;
    for (int i = 0; i < EYE_ROOM_EDGES && e->strip; i++) {
        const eye_edge *edge = &room->edges[i];
        double rows = edge->high - edge->low;
        if (edge->high > 0 && edge->low < e->camera->height && rows > most) most = rows;
    }
    return most < STEEP_ROWS ? 1 : most < STEEP_ROWS * MOST_PARTS ? 1 + (int)(most / STEEP_ROWS) : MOST_PARTS;
}

/* What lies between two columns, between which no surface begins or ends. */
static void paint_piece(eye_state *e, const eye_scratch *k, double u0, double u1, float *column) {
    double s0 = ray_at(e, u0), s1 = ray_at(e, u1);
    eye_stack stack = {.edges = k->edges};
    start_with_room(e, s0, s1, &stack);
    int parts = parts_of(e, &stack);
    if (parts == 1) {
        finish(e, k, s0, s1, &stack, column);
        return;
    }
    memset(column, 0, (size_t)e->camera->height * sizeof *column);
    for (int i = 0; i < parts; i++) {
        double from = s0 + (s1 - s0) * i / parts, to = s0 + (s1 - s0) * (i + 1) / parts;
        start_with_room(e, from, to, &stack);
        finish(e, k, from, to, &stack, k->part);
        add(column, k->part, 1.0f / (float)parts, e->camera->height);
    }
}

static void paint_column(eye_state *e, const eye_scratch *k, int x, int *cut, float *column) {
    if (*cut == e->cuts || k->cuts[*cut] >= x + 1) {
        paint_piece(e, k, x, x + 1, column);
        return;
    }
    memset(column, 0, (size_t)e->camera->height * sizeof *column);
    for (double from = x; from < x + 1;) {
        double to = *cut < e->cuts && k->cuts[*cut] < x + 1 ? k->cuts[(*cut)++] : x + 1;
        if (to > from) {
            paint_piece(e, k, from, to, k->piece);
            add(column, k->piece, (float)(to - from), e->camera->height);
        }
        from = to;
    }
}

void eye_view(const lobula_eye_scene *scene, const lobula_eye_camera *camera, const eye_moment *moment,
              const eye_scratch *scratch, float *columns) {
    eye_state e = {.scene = scene, .camera = camera, .light = (float)moment->light,
                   .middle_x = 0.5 * camera->width, .middle_y = 0.5 * camera->height, .per_px = 1 / camera->focal_px,
                   .pupil = pupil_at(scene, moment->camera, camera->ahead_cm)};
    e.strip = moment->wall_pattern && scene->wall.samples > 0 ? &scene->wall : NULL;
    e.wall_grey = eye_strip_grey(&scene->wall);
    set_walls(&e, scratch->cuts);
    for (int32_t i = 0; i < scene->obstacles; i++)
        if (!moment->obstacles || moment->obstacles[i])
            add_cylinder(&e, &scene->obstacle[i], scene->obstacle_poses + 3 * i, scratch);
    for (int64_t i = 0; i < moment->bodies; i++)
        if (i != moment->own && (!moment->shown || moment->shown[i]))
            add_cylinder(&e, &scene->body, moment->poses + 3 * i, scratch);
    int cut = 0;
    for (int x = 0; x < camera->width; x++)
        paint_column(&e, scratch, x, &cut, columns + (ptrdiff_t)x * camera->height);
}
