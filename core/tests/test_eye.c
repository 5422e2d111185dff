/* The eye: pictures worked out by hand, what leaves no trace, and thousands of odd views under the sanitizers. */
#include "check.h"

#include <math.h>

#include "lobula_eye.h"

static const double PI = 3.14159265358979323846;

/* A room of 60 x 40 cm with a wall of grey 200 and 10 cm, floor 50, 250 above; robots of radius 2 cm, 3 cm high. */
static const double plain_sums[2] = {0, 200}, body_grey[1] = {20};

static lobula_eye_scene plain_room(void) {
    lobula_eye_scene s = {.shape = LOBULA_EYE_BOX, .width_cm = 60, .depth_cm = 40, .wall_cm = 10, .floor_grey = 50,
                          .above_grey = 250, .wall = {plain_sums, 1, 0},
                          .body = {.radius_cm = 2, .height_cm = 3, .bands_grey = body_grey, .bands = 1}};
    return s;
}

/* 90 degrees over 100 columns: the focal length is 50 px. The pupil sits at the centre, 2 cm up. */
static lobula_eye_camera wide_camera(void) {
    lobula_eye_camera c = {.width = 100, .height = 60, .focal_px = 50, .above_floor_cm = 2};
    return c;
}

static void draw(const lobula_eye_scene *s, const lobula_eye_camera *c, const lobula_eye_views *v, int isa,
                 uint8_t *out) {
    void *workspace = memory(lobula_eye_workspace_size(s, c, v->bodies));
    CHECK(lobula_eye_draw(s, c, v, workspace, isa, out) == LOBULA_OK, "views that can be drawn");
    free(workspace);
}

/* 20 cm before the wall: its foot is 50 * 2 / 20 = 5 rows under the middle, its top 50 * 8 / 20 = 20 rows over it. */
static void wall_by_hand(void) {
    static uint8_t out[60][100];
    const double camera[3] = {40, 20, 0};
    lobula_eye_scene s = plain_room();
    lobula_eye_camera c = wide_camera();
    lobula_eye_views v = {.count = 1, .cameras = camera};
    draw(&s, &c, &v, LOBULA_ISA_AUTO, out[0]);
    for (int x = 0; x < 100; x++)
        for (int y = 0; y < 60; y++) CHECK(out[y][x] == (y < 10 ? 250 : y < 35 ? 200 : 50), "above, wall, floor");
    c.above_floor_cm = 2.1; /* foot 5.25 rows under the middle, top 19.75 over it */
    draw(&s, &c, &v, LOBULA_ISA_AUTO, out[0]);
    CHECK(out[10][50] == 213, "1/4 above, 3/4 wall"); /* 200 + 50 / 4 = 212.5 */
    CHECK(out[35][50] == 88, "1/4 wall, 3/4 floor");  /* 50 + 150 / 4 = 87.5 */
}

/* A body 8 cm ahead: rays graze it at tan = 2 / sqrt(64 - 4), 12.910 columns from the middle; its near side is at 6 cm,
 * so its foot is 50 * 2 / 6 = 16.67 rows under the middle, its top 8.33 over it. */
static void body_by_hand(void) {
    static uint8_t out[60][100];
    const double camera[3] = {30, 20, PI / 2}, bodies[6] = {30, 20, 0, 30, 28, 1};
    const int32_t own[1] = {0};
    lobula_eye_scene s = plain_room();
    lobula_eye_camera c = wide_camera();
    lobula_eye_views v = {.count = 1, .bodies = 2, .cameras = camera, .poses = bodies, .own = own};
    draw(&s, &c, &v, LOBULA_ISA_AUTO, out[0]);
    for (int x = 0; x < 100; x++) {
        int inside = x >= 38 && x < 62, outside = x < 37 || x >= 63;
        CHECK(!inside || out[30][x] == 20, "the body");
        CHECK(!outside || out[30][x] == 200, "the wall beside it");
    }
    CHECK(out[30][37] == 36 && out[30][62] == 36, "0.910 of a column: 20 + 0.090 * 180 = 36.2");
    CHECK(out[20][50] == 200 && out[21][50] == 140 && out[22][50] == 20, "its top at 21.67: 20 / 3 + 200 * 2 / 3");
    CHECK(out[45][50] == 20 && out[46][50] == 30 && out[47][50] == 50, "its foot at 46.67: 20 * 2 / 3 + 50 / 3");
}

typedef struct {
    uint64_t state;
} dice;

static double between(dice *d, double low, double high) {
    d->state = d->state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(d->state >> 40) / (double)(1 << 24);
}

static int below(dice *d, int n) { return (int)between(d, 0, n); }

enum { SAMPLES = 257, BODIES = 5, OBSTACLES = 3, VIEWS = 3, BANDS = 3 };

/* Everything that a view may be drawn from, at odd sizes and places. */
typedef struct {
    double wall[SAMPLES + 1], around[9], bands[BANDS], cameras[VIEWS][3], poses[VIEWS][BODIES][3], fixed[OBSTACLES][3],
        light[VIEWS];
    lobula_eye_cylinder obstacle[OBSTACLES];
    uint64_t keys[VIEWS];
    int32_t own[VIEWS];
    uint8_t shown[VIEWS][BODIES], stands[VIEWS][OBSTACLES], walls[VIEWS];
    lobula_eye_scene scene;
    lobula_eye_camera camera;
    lobula_eye_views views;
} world;

static void draw_sums(dice *d, double *sums, int samples, double low, double high) {
    sums[0] = 0;
    for (int i = 0; i < samples; i++) sums[i + 1] = sums[i] + between(d, low, high);
}

static lobula_eye_cylinder draw_cylinder(dice *d, const world *w) {
    lobula_eye_cylinder c = {.radius_cm = between(d, 0.1, 6), .height_cm = between(d, 0.1, 15), .bands_grey = w->bands,
                             .bands = 1 + below(d, BANDS)};
    if (below(d, 2)) c.around = (lobula_eye_strip){w->around, 8, 0};
    return c;
}

/* Near the wall, in a corner, on a body or beside it, outside the room, or anywhere. */
static void draw_pose(dice *d, const world *w, double *pose) {
    double width = w->scene.width_cm, depth = w->scene.depth_cm, tiny = between(d, 0, 1) * (below(d, 2) ? 1e-9 : 0.02);
    int kind = below(d, 6);
    pose[0] = kind == 0 ? tiny : kind == 1 ? width - tiny : kind == 2 ? -3 : between(d, 0, width);
    pose[1] = kind == 0 ? depth - tiny : kind == 2 ? depth + 5 : between(d, 0, depth);
    pose[2] = below(d, 4) ? between(d, -10, 10) : (below(d, 9) - 4) * PI / 4;
}

static void draw_world(dice *d, world *w) {
    int circle = below(d, 2);
    memset(w, 0, sizeof *w);
    draw_sums(d, w->wall, SAMPLES, 0, 255);
    draw_sums(d, w->around, 8, -100, 100);
    for (int i = 0; i < BANDS; i++) w->bands[i] = between(d, -50, 300);
    w->scene = (lobula_eye_scene){.shape = circle, .obstacles = below(d, OBSTACLES + 1), .width_cm = between(d, 1, 90),
                                  .wall_cm = between(d, 0.1, 20), .floor_grey = between(d, 0, 255),
                                  .above_grey = between(d, 0, 255), .wall = {w->wall, SAMPLES, 0},
                                  .obstacle = w->obstacle, .obstacle_poses = w->fixed[0]};
    w->scene.depth_cm = circle ? w->scene.width_cm : between(d, 1, 90);
    w->scene.body = draw_cylinder(d, w);
    for (int i = 0; i < OBSTACLES; i++) {
        w->obstacle[i] = draw_cylinder(d, w);
        draw_pose(d, w, w->fixed[i]);
    }
    w->camera = (lobula_eye_camera){.width = 1 + below(d, 60), .height = 1 + below(d, 50), .focal_px = between(d, 1, 90),
                                    .ahead_cm = below(d, 2) ? between(d, 0, 2) : 0, .above_floor_cm = between(d, 0.1, 5),
                                    .noise_grey = below(d, 2) ? between(d, 0, 100) : 0,
                                    .blur_px = below(d, 3) ? 0 : between(d, 0.1, 20)};
    for (int i = 0; i < VIEWS; i++) {
        draw_pose(d, w, w->cameras[i]);
        for (int j = 0; j < BODIES; j++) {
            draw_pose(d, w, w->poses[i][j]);
            if (!below(d, 3)) { /* where the camera is, or touching */
                w->poses[i][j][0] = w->cameras[i][0] + (below(d, 2) ? w->scene.body.radius_cm : 0);
                w->poses[i][j][1] = w->cameras[i][1];
            }
            w->shown[i][j] = below(d, 4) > 0;
        }
        for (int j = 0; j < OBSTACLES; j++) w->stands[i][j] = below(d, 4) > 0;
        w->own[i] = below(d, BODIES + 1) - 1;
        w->keys[i] = d->state;
        w->light[i] = below(d, 2) ? between(d, 0, 3) : 1000 * below(d, 2);
        w->walls[i] = below(d, 4) > 0;
    }
    w->views = (lobula_eye_views){.count = VIEWS, .bodies = BODIES, .cameras = w->cameras[0], .poses = w->poses[0][0],
                                  .poses_step = 3 * BODIES, .own = w->own, .keys = w->keys, .light = w->light,
                                  .shown = w->shown[0], .walls = w->walls};
}

/* Each view alone, and on each instruction set, is what it was among the others. */
static void odd_views(int rounds) {
    dice d = {2020};
    world *w = memory(sizeof *w);
    for (int round = 0; round < rounds; round++) {
        draw_world(&d, w);
        size_t pixels = (size_t)w->camera.width * (size_t)w->camera.height;
        uint8_t *out = memory(VIEWS * pixels), *alone = memory(pixels);
        if (w->scene.obstacles == OBSTACLES) w->views.obstacles = w->stands[0];
        draw(&w->scene, &w->camera, &w->views, LOBULA_ISA_AUTO, out);
        for (int i = 0; i < VIEWS; i++) {
            lobula_eye_views one = w->views;
            one.count = 1;
            one.cameras = w->cameras[i];
            one.poses = w->poses[i][0];
            one.own = &w->own[i];
            one.keys = &w->keys[i];
            one.light = &w->light[i];
            one.shown = w->shown[i];
            one.walls = &w->walls[i];
            if (one.obstacles) one.obstacles = w->stands[i];
            for (int isa = 0; lobula_isa_name(isa); isa++) {
                if (!lobula_isa_runs(isa)) continue;
                draw(&w->scene, &w->camera, &one, isa, alone);
                CHECK(memcmp(alone, out + (size_t)i * pixels, pixels) == 0, "a view does not depend on the others");
            }
        }
        free(out);
        free(alone);
    }
    free(w);
}

/* Without light all is black, and without pattern or noise no grey is seen that the scene has not: whatever the pose. */
static void no_other_greys(int rounds) {
    dice d = {7};
    world *w = memory(sizeof *w);
    for (int round = 0; round < rounds; round++) {
        draw_world(&d, w);
        size_t pixels = (size_t)w->camera.width * (size_t)w->camera.height;
        uint8_t *out = memory(VIEWS * pixels);
        for (int i = 0; i < BANDS; i++) w->bands[i] = 100 + 20 * i;
        w->scene.floor_grey = 101;
        w->scene.above_grey = 139;
        w->scene.body.around = w->obstacle[0].around = w->obstacle[1].around = w->obstacle[2].around =
            (lobula_eye_strip){NULL, 0, 0};
        w->views.walls = NULL;
        draw_sums(&d, w->wall, SAMPLES, 100, 140);
        w->views.light = NULL;
        w->views.keys = NULL;
        draw(&w->scene, &w->camera, &w->views, LOBULA_ISA_AUTO, out);
        for (size_t i = 0; i < VIEWS * pixels; i++) CHECK(out[i] >= 100 && out[i] <= 140, "between the greys there are");
        free(out);
    }
    free(w);
}

static void refused(void) {
    static uint8_t out[60 * 100];
    double camera[3] = {30, 20, 0}, light = 1, bodies[3] = {10, 10, 0};
    int32_t own = 0;
    const lobula_eye_scene good = plain_room();
    const lobula_eye_camera c = wide_camera();
    lobula_eye_views v = {.count = 1, .bodies = 1, .cameras = camera, .poses = bodies, .own = &own, .light = &light};
    void *workspace = memory(lobula_eye_workspace_size(&good, &c, 1));
    const double wrong[] = {NAN, INFINITY, -INFINITY, 1e9};
    CHECK(lobula_eye_abi() == LOBULA_EYE_ABI, "one header");
    for (int i = 0; i < 4; i++) {
        lobula_eye_scene s = good;
        lobula_eye_camera bad = c;
        double *places[] = {&camera[0], &camera[2], &bodies[1], &light, &s.wall_cm, &s.width_cm, &s.floor_grey,
                            &s.body.radius_cm, &bad.focal_px, &bad.noise_grey, &bad.blur_px, &bad.above_floor_cm};
        for (size_t j = 0; j < sizeof places / sizeof *places; j++) {
            double before = *places[j];
            *places[j] = wrong[i];
            CHECK(lobula_eye_draw(&s, &bad, &v, workspace, LOBULA_ISA_AUTO, out) == LOBULA_BAD_ARGUMENT, "a number");
            CHECK(j < 4 || lobula_eye_workspace_size(&s, &bad, 1) == 0, "no such eye");
            *places[j] = before;
        }
    }
    lobula_eye_scene s = good;
    s.body.bands = 0;
    CHECK(lobula_eye_workspace_size(&s, &c, 1) == 0, "a body has a grey");
    s = good;
    s.obstacles = 1;
    CHECK(lobula_eye_workspace_size(&s, &c, 1) == 0, "obstacles somewhere");
    CHECK(lobula_eye_workspace_size(&good, &c, -1) == 0, "bodies are counted from 0");
    own = 1;
    CHECK(lobula_eye_draw(&good, &c, &v, workspace, LOBULA_ISA_AUTO, out) == LOBULA_BAD_ARGUMENT, "no such body");
    own = -1;
    CHECK(lobula_eye_draw(&good, &c, &v, workspace, 99, out) == LOBULA_BAD_ARGUMENT, "no such instruction set");
    CHECK(lobula_eye_draw(NULL, &c, &v, workspace, 0, out) == LOBULA_BAD_ARGUMENT, "no scene");
    CHECK(lobula_eye_draw(&good, &c, &v, workspace, LOBULA_ISA_AUTO, out) == LOBULA_OK, "all good");
    v.count = 0;
    CHECK(lobula_eye_draw(&good, &c, &v, workspace, LOBULA_ISA_AUTO, out) == LOBULA_OK, "nothing to draw");
    free(workspace);
}

int main(void) {
    wall_by_hand();
    body_by_hand();
    odd_views(400);
    no_other_greys(400);
    refused();
    puts("eye: good");
    return 0;
}
