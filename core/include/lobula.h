/* lobula: four insect neurons that say, from one camera, that something is going to hit it.
 *
 * The C core of the Python package `lobula`, and the same source for a microcontroller. It computes what the package's
 * `model` folder defines, row by row, in one pass over the picture. No heap, no globals, no threads: every byte comes
 * from the caller, so any number of networks may run side by side.
 *
 *     lobula_params p;  fill it (the Python package writes it as C for any preset)
 *     void *state = aligned_alloc(LOBULA_ALIGN, lobula_state_size(&p, 99, 72));
 *     void *workspace = aligned_alloc(LOBULA_ALIGN, lobula_workspace_size(&p, 99, 72, 1));
 *     lobula_init(state, &p, 99, 72, LOBULA_ISA_AUTO);
 *     for each frame: lobula_step(&net, &image, time_s, 0, &reading, NULL);
 *
 * Images are luminance, 0..255, row by row. Floats must be finite: lobula_in_range() tells.
 */
#ifndef LOBULA_H
#define LOBULA_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define LOBULA_API __declspec(dllexport)
#elif defined(__GNUC__)
#define LOBULA_API __attribute__((visibility("default")))
#else
#define LOBULA_API
#endif

#define LOBULA_ABI 2        /* changes when anything in this file does */
#define LOBULA_ALIGN 64     /* alignment of the state and of the workspace, bytes */
#define LOBULA_MAX_SPANS 8
#define LOBULA_MIN_WIDTH 32
#define LOBULA_MIN_HEIGHT 24
#define LOBULA_MAX_SIDE 32768

/* What a call returns: 0, or the reason why nothing was done. */
enum {
    LOBULA_OK = 0,
    LOBULA_BAD_ARGUMENT = -1, /* a null pointer, a size or a setting that cannot be */
    LOBULA_BAD_STATE = -2     /* not a state of lobula_init, or of another ABI */
};

/* ---- Settings: the fields, names and units of the Python package, which documents each of them. -------------- */
/* Numbers are all doubles: switches are 0 or 1, choices count from 0 in the order of the comment. */

typedef struct {
    double period_ms, change_exponent, max_gap_ms, repeats, repeat_hold_ms, repeat_mean_grey, repeat_max_grey;
} lobula_clock_params;

typedef struct {
    double enabled, min_change_grey, min_coverage, trim, min_explained, min_gain, max_gain;
} lobula_flash_params;

typedef struct {
    double enabled, limit_grey;
} lobula_saturation_params;

typedef struct {
    double patch_px, floor_grey;
} lobula_coarse_params;

typedef struct {
    double enabled, radius_px, sigma_px, surround, dead_zone_grey;
} lobula_dog_params;

typedef struct {
    double residual;
} lobula_on_off_params;

typedef struct {
    double enabled, rise_ms;
} lobula_fdsr_params;

typedef struct {
    lobula_dog_params dog;
    lobula_on_off_params on_off;
    lobula_fdsr_params fdsr;
} lobula_lamina_params;

typedef struct {
    double centre_weight, nearest_weight, diagonal_weight, centre_ms, nearest_ms, diagonal_ms, bias;
} lobula_inhibition_params;

typedef struct {
    double enabled, threshold_grey, floor_grey, divisor;
} lobula_grouping_params;

typedef struct {
    double enabled, tau_ms, growth;
} lobula_sfa_params;

typedef struct {
    double gain, threshold;
} lobula_spiking_params;

typedef struct {
    double reads; /* change, lamina */
    lobula_inhibition_params on, off;
    double neighbour_px, change_scale_grey, change_ms, on_gain, off_gain, product_gain;
    lobula_grouping_params grouping;
    double coarse_gain, coarse_on_weight;
    double sigmoid_grey;
    lobula_sfa_params sfa;
    lobula_spiking_params spiking;
} lobula_lgmd_params;

typedef struct {
    double spans; /* how many of the pairs below are in use */
    double spans_px[LOBULA_MAX_SPANS], delays_ms[LOBULA_MAX_SPANS];
} lobula_emd_params;

typedef struct {
    lobula_emd_params emd;
    double sigmoid_grey2;
    lobula_spiking_params spiking;
} lobula_lptc_params;

typedef struct {
    double neurons; /* all, lgmds, lgmd2 */
    double window_ms, collision_spikes, lptc_weight, end_ms, warm_up_ms, after_turn_ms;
} lobula_decision_params;

typedef struct {
    lobula_clock_params clock;
    lobula_flash_params flash;
    lobula_saturation_params saturation;
    lobula_coarse_params coarse;
    lobula_lamina_params lamina;
    lobula_lgmd_params lgmd1, lgmd2;
    lobula_lptc_params lptc;
    lobula_decision_params decision;
} lobula_params;

/* ---- What goes in and what comes out. ------------------------------------------------------------------------- */

enum { LOBULA_UINT8 = 0, LOBULA_FLOAT32 = 1 };

typedef struct {
    const void *pixels;    /* first pixel of the first image; pixels of a row lie side by side */
    ptrdiff_t row_bytes;   /* from one row to the next */
    ptrdiff_t image_bytes; /* from one image of a block to the next */
    int32_t type;          /* LOBULA_UINT8 or LOBULA_FLOAT32 */
    int32_t reserved;
} lobula_images;

enum { LOBULA_STATE_OK, LOBULA_STATE_WARMING_UP, LOBULA_STATE_STALE, LOBULA_STATE_FLASH, LOBULA_STATE_TURNING };

typedef struct {
    double time_s;
    double lgmd1, lgmd2;   /* membrane potentials in [0.5, 1) */
    double lptc_r, lptc_l; /* in [0, 1) and (-1, 0] */
    int32_t spikes[4];     /* lgmd1, lgmd2, lptc_r, lptc_l */
    int32_t collision;     /* 0 or 1 */
    int32_t state;         /* LOBULA_STATE_... */
} lobula_reading;

/* Maps of a step, each (height, width) float32, given as an array of pointers in this order; NULL: not wanted. */
enum {
    LOBULA_TAP_CHANGE, LOBULA_TAP_LAMINA, LOBULA_TAP_ADAPTED_ON, LOBULA_TAP_ADAPTED_OFF, LOBULA_TAP_MOTION,
    LOBULA_TAP_LGMD1_INHIBITION_ON, LOBULA_TAP_LGMD1_INHIBITION_OFF, LOBULA_TAP_LGMD1_SUMMATION,
    LOBULA_TAP_LGMD1_GROUPED,
    LOBULA_TAP_LGMD2_INHIBITION_ON, LOBULA_TAP_LGMD2_INHIBITION_OFF, LOBULA_TAP_LGMD2_SUMMATION,
    LOBULA_TAP_LGMD2_GROUPED,
    LOBULA_TAPS
};

/* The memory of one network. Streams that take turns on one thread may share a workspace. */
typedef struct {
    void *state;     /* lobula_state_size() bytes, aligned to LOBULA_ALIGN; may be copied with memcpy */
    void *workspace; /* lobula_workspace_size() bytes, aligned to LOBULA_ALIGN; holds nothing between calls */
} lobula_net;

/* ---- Calls. --------------------------------------------------------------------------------------------------- */

enum { LOBULA_ISA_AUTO = -1 };

LOBULA_API int lobula_abi(void);
LOBULA_API size_t lobula_params_size(void);

/* Instruction sets this build holds, from the plainest up; NULL past the last. */
LOBULA_API const char *lobula_isa_name(int isa);
/* Whether this processor runs it, and the best that it does. */
LOBULA_API int lobula_isa_runs(int isa);
LOBULA_API int lobula_isa_best(void);

/* Bytes needed; 0 where the size or the settings cannot be. `frames` is the number a block works on at once. */
LOBULA_API size_t lobula_state_size(const lobula_params *p, int width, int height);
LOBULA_API size_t lobula_workspace_size(const lobula_params *p, int width, int height, int frames);
/* The number of frames at once that is fastest for such a network: 1 while its state fits the cache. */
LOBULA_API int lobula_block_frames(const lobula_params *p, int width, int height);

LOBULA_API int lobula_init(void *state, const lobula_params *p, int width, int height, int isa);
LOBULA_API int lobula_reset(void *state);

/* Advance by one frame. `turning`: the camera itself turns. `taps`: LOBULA_TAPS pointers, or NULL. */
LOBULA_API int lobula_step(const lobula_net *net, const lobula_images *image, double time_s, int turning,
                           lobula_reading *reading, float *const *taps);

/* Advance by `count` frames, `frames` of them at once (the workspace must be as large); the same numbers as single
 * steps. `turning` is one byte a frame, or NULL. */
LOBULA_API int lobula_run(const lobula_net *net, const lobula_images *images, const double *times_s,
                          const uint8_t *turning, int64_t count, int frames, lobula_reading *readings);

/* 1 where every float lies in 0..255 (so none is NaN or infinite), else 0. */
LOBULA_API int lobula_in_range(const lobula_images *image, int width, int height);

/* ---- Saving and loading a state, by plane and by number. ------------------------------------------------------ */

enum {
    LOBULA_PLANE_LUMA, LOBULA_PLANE_ON, LOBULA_PLANE_OFF, LOBULA_PLANE_ADAPTED_ON, LOBULA_PLANE_ADAPTED_OFF,
    LOBULA_PLANE_CHANGE_ON, LOBULA_PLANE_CHANGE_OFF,
    LOBULA_PLANES
};

/* Copy a plane (height, width) out or in. One that these settings do not keep reads as zero and is not written. */
LOBULA_API int lobula_get_plane(const void *state, int plane, float *out);
LOBULA_API int lobula_set_plane(void *state, int plane, const float *in);

typedef struct {
    double raw, potential, change_before;
} lobula_lgmd_scalars;

typedef struct {
    double time_s, lgmd1, lgmd2, lptc;
} lobula_decision_entry;

/* A time that was never set is told by its has_ flag. */
typedef struct {
    double frame_s, tick_s, step_s, started_s, turned_s, held_s;
    int32_t has_frame, has_turned, has_held;
    int32_t still, flashing;
    lobula_lgmd_scalars lgmd1, lgmd2;
    double rightward, leftward;
} lobula_scalars;

LOBULA_API int lobula_get_scalars(const void *state, lobula_scalars *out);
LOBULA_API int lobula_set_scalars(void *state, const lobula_scalars *in);

/* The decision's window of spikes: how many entries it holds; copy them out; replace them (at most the capacity). */
LOBULA_API int lobula_window_capacity(const void *state);
LOBULA_API int lobula_window_count(const void *state);
LOBULA_API int lobula_get_window(const void *state, lobula_decision_entry *out);
LOBULA_API int lobula_set_window(void *state, const lobula_decision_entry *in, int count);

/* ---- From a decoder's plane to the working size. --------------------------------------------------------------- */

/* Area average of a crop of a picture, to (out_height, out_width) float32: every output pixel is the mean of the
 * source under it, edges counted by the covered share, times `gain` plus `offset`, kept within 0..255. */
typedef struct {
    int32_t source_width, source_height;
    int32_t crop_x, crop_y, crop_width, crop_height;
    int32_t out_width, out_height;
    double gain, offset;
} lobula_resize_spec;

LOBULA_API size_t lobula_resize_size(const lobula_resize_spec *spec);
LOBULA_API int lobula_resize_init(void *plan, const lobula_resize_spec *spec, int isa);
/* `source` starts at the whole picture's first pixel; `plan` serves as scratch: one thread at a time. */
LOBULA_API int lobula_resize(void *plan, const lobula_images *source, float *out);

#ifdef __cplusplus
}
#endif
#endif
