/* Checks what it is given, then draws view by view: luminance, blur, sensor. */
#include "lobula_eye.h"

#include <math.h>

#include "eye_blur.h"
#include "eye_sensor.h"
#include "eye_view.h"

extern const eye_kernels eye_kernels_base;
#ifdef LOBULA_WITH_V3
extern const eye_kernels eye_kernels_v3;
#endif
#ifdef LOBULA_WITH_V4
extern const eye_kernels eye_kernels_v4;
#endif

/* In the order of isa.c. */
static const eye_kernels *const built[] = {
    &eye_kernels_base,
#ifdef LOBULA_WITH_V3
    &eye_kernels_v3,
#endif
#ifdef LOBULA_WITH_V4
    &eye_kernels_v4,
#endif
};

typedef struct {
    eye_scratch scratch;
    float *columns, *spare;
    uint8_t *bytes;
    size_t size;
} eye_memory;

static char *take(char *base, size_t *used, size_t bytes) {
    char *at = base ? base + *used : NULL;
    *used += (bytes + LOBULA_ALIGN - 1) / LOBULA_ALIGN * LOBULA_ALIGN;
    return at;
}

static size_t edges_of(const lobula_eye_scene *scene, int64_t bodies) {
    size_t edges = EYE_ROOM_EDGES + (size_t)bodies * (size_t)(scene->body.bands + EYE_EDGES);
    for (int32_t i = 0; i < scene->obstacles; i++) edges += (size_t)(scene->obstacle[i].bands + EYE_EDGES);
    return edges;
}

static eye_memory memory_at(void *base, const lobula_eye_scene *scene, const lobula_eye_camera *c, int64_t bodies) {
    eye_memory m = {.size = 0};
    size_t pixels = (size_t)c->width * (size_t)c->height, cylinders = (size_t)bodies + (size_t)scene->obstacles;
    m.scratch.cylinders = (void *)take(base, &m.size, cylinders * sizeof(eye_cylinder));
    m.scratch.cuts = (void *)take(base, &m.size, (cylinders * EYE_CUTS + EYE_ROOM_CUTS) * sizeof(double));
    m.scratch.edges = (void *)take(base, &m.size, edges_of(scene, bodies) * sizeof(eye_edge));
    m.scratch.piece = (void *)take(base, &m.size, (size_t)c->height * sizeof(float));
    m.scratch.part = (void *)take(base, &m.size, (size_t)c->height * sizeof(float));
    m.columns = (void *)take(base, &m.size, pixels * sizeof(float));
    m.spare = (void *)take(base, &m.size, c->blur_px > 0 ? pixels * sizeof(float) : 0);
    m.bytes = (void *)take(base, &m.size, pixels);
    return m;
}

/* NaN is never between. */
static int between(double x, double low, double high) { return x >= low && x <= high; }

static int length_is_good(double cm) { return between(cm, 1e-3, 1e6); }

static int pose_is_good(const double *p) {
    return between(p[0], -1e6, 1e6) && between(p[1], -1e6, 1e6) && between(p[2], -1e6, 1e6);
}

static int strip_is_good(const lobula_eye_strip *s) { return s->samples == 0 || (s->samples > 0 && s->sums); }

static int cylinder_is_good(const lobula_eye_cylinder *c) {
    return length_is_good(c->radius_cm) && length_is_good(c->height_cm) && c->bands >= 1 &&
           c->bands <= LOBULA_EYE_MAX_BANDS && c->bands_grey && strip_is_good(&c->around);
}

static int camera_is_good(const lobula_eye_camera *c) {
    return c->width >= 1 && c->height >= 1 && c->width <= LOBULA_MAX_SIDE && c->height <= LOBULA_MAX_SIDE &&
           (int64_t)c->width * c->height <= INT32_MAX / 2 && between(c->focal_px, 1e-3, 1e6) &&
           between(c->ahead_cm, -1e6, 1e6) && length_is_good(c->above_floor_cm) &&
           between(c->noise_grey, 0, LOBULA_EYE_MAX_NOISE) && between(c->blur_px, 0, EYE_MAX_BLUR);
}

static int scene_is_good(const lobula_eye_scene *s) {
    if ((s->shape != LOBULA_EYE_BOX && s->shape != LOBULA_EYE_CIRCLE) || s->obstacles < 0 ||
        s->obstacles > LOBULA_EYE_MAX_CYLINDERS || (s->obstacles && (!s->obstacle || !s->obstacle_poses)))
        return 0;
    for (int32_t i = 0; i < s->obstacles; i++)
        if (!cylinder_is_good(&s->obstacle[i]) || !pose_is_good(s->obstacle_poses + 3 * i)) return 0;
    return between(s->width_cm, 0.1, 1e6) && between(s->depth_cm, 0.1, 1e6) && length_is_good(s->wall_cm) &&
           between(s->floor_grey, 0, 255) && between(s->above_grey, 0, 255) && strip_is_good(&s->wall) &&
           cylinder_is_good(&s->body);
}

static int views_are_good(const lobula_eye_views *v) {
    if (v->count < 0 || v->bodies < 0 || v->bodies > LOBULA_EYE_MAX_CYLINDERS || (v->count && !v->cameras) ||
        (v->bodies && !v->poses))
        return 0;
    for (int64_t i = 0; i < v->count; i++) {
        if (!pose_is_good(v->cameras + 3 * i) || (v->light && !between(v->light[i], 0, LOBULA_EYE_MAX_LIGHT)) ||
            (v->own && (v->own[i] < -1 || v->own[i] >= v->bodies)))
            return 0;
        for (int64_t j = 0; j < v->bodies && (i == 0 || v->poses_step); j++)
            if (!pose_is_good(v->poses + i * v->poses_step + 3 * j)) return 0;
    }
    return 1;
}

/* Mixes a key so that near ones differ in every bit. */
static eye_noise noise_of(uint64_t key, double noise_grey) {
    key += UINT64_C(0x9e3779b97f4a7c15);
    key = (key ^ (key >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    key = (key ^ (key >> 27)) * UINT64_C(0x94d049bb133111eb);
    key ^= key >> 31;
    double scale = floor(noise_grey * EYE_GREY / EYE_BYTES_SD * (1 << EYE_SCALE_BITS) + 0.5);
    eye_noise noise = {(uint32_t)key, (uint32_t)(key >> 32), (int32_t)scale};
    return noise;
}

int lobula_eye_abi(void) { return LOBULA_EYE_ABI; }

size_t lobula_eye_workspace_size(const lobula_eye_scene *scene, const lobula_eye_camera *camera, int64_t bodies) {
    if (!scene || !camera || bodies < 0 || bodies > LOBULA_EYE_MAX_CYLINDERS || !scene_is_good(scene) ||
        !camera_is_good(camera))
        return 0;
    return memory_at(NULL, scene, camera, bodies).size;
}

int lobula_eye_draw(const lobula_eye_scene *scene, const lobula_eye_camera *camera, const lobula_eye_views *v,
                    void *workspace, int isa, uint8_t *out) {
    if (!scene || !camera || !v || !workspace || !out) return LOBULA_BAD_ARGUMENT;
    if (isa == LOBULA_ISA_AUTO) isa = lobula_isa_best();
    if (!lobula_isa_runs(isa) || !scene_is_good(scene) || !camera_is_good(camera) || !views_are_good(v))
        return LOBULA_BAD_ARGUMENT;
    eye_memory m = memory_at(workspace, scene, camera, v->bodies);
    for (int64_t i = 0; i < v->count; i++) {
        eye_moment moment = {.camera = v->cameras + 3 * i, .poses = v->poses + i * v->poses_step, .bodies = v->bodies,
                             .shown = v->shown ? v->shown + i * v->bodies : NULL,
                             .obstacles = v->obstacles ? v->obstacles + i * scene->obstacles : NULL,
                             .own = v->own ? v->own[i] : -1, .light = v->light ? v->light[i] : 1.0,
                             .wall_pattern = !v->walls || v->walls[i]};
        eye_noise noise = noise_of(v->keys ? v->keys[i] : 0, v->keys ? camera->noise_grey : 0.0);
        eye_view(scene, camera, &moment, &m.scratch, m.columns);
        if (camera->blur_px > 0) eye_blur(m.columns, m.spare, camera->width, camera->height, camera->blur_px);
        built[isa]->sense(m.columns, camera->width, camera->height, noise, m.bytes,
                          out + i * camera->width * camera->height);
    }
    return LOBULA_OK;
}
