/* lobula: four insect neurons that say, from one camera, that something is going to hit it.
 *
 * The C core of the Python package `lobula`; robot/lobula.h is the same on a microcontroller. It computes what the package's
 * `model` folder defines, row by row, in one pass over the picture. No heap, no globals, no threads: every byte comes
 * from the caller, so any number of networks may run side by side.
 *
 *     lobula_params p;  fill it (the Python package writes it as C for any preset)
 *     int storage = LOBULA_FLOAT;
 *     void *state = aligned_alloc(LOBULA_ALIGN, lobula_state_size(&p, 99, 72, storage));
 *     void *workspace = aligned_alloc(LOBULA_ALIGN, lobula_workspace_size(&p, 99, 72, storage, 1));
 *     lobula_init(state, &p, 99, 72, storage, LOBULA_ISA_AUTO);
 *     for each frame: lobula_step(&net, &image, time_s, 0, &reading, NULL);
 *
 * Images are luminance, 0..255, row by row. Floats must be finite: lobula_in_range() tells.
 */
#ifndef LOBULA_H
#define LOBULA_H

#include <stddef.h>
#include <stdint.h>

#ifndef LOBULA_LAPTOP
#define LOBULA_LAPTOP /* all numbers are doubles */
#endif
#include "lobula_types.h"

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

/* ---- What goes in. Settings, readings and maps stand in lobula_types.h. ------------------------------------------ */

typedef struct {
    const void *pixels;    /* first pixel of the first image; pixels of a row lie side by side */
    ptrdiff_t row_bytes;   /* from one row to the next */
    ptrdiff_t image_bytes; /* from one image of a block to the next */
    int32_t type;          /* LOBULA_UINT8 or LOBULA_FLOAT32 */
    int32_t reserved;
} lobula_images;

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
LOBULA_API size_t lobula_state_size(const lobula_params *p, int width, int height, int storage);
LOBULA_API size_t lobula_workspace_size(const lobula_params *p, int width, int height, int storage, int frames);
/* The number of frames at once that is fastest for such a network: 1 while its state fits the cache. */
LOBULA_API int lobula_block_frames(const lobula_params *p, int width, int height, int storage);

LOBULA_API int lobula_init(void *state, const lobula_params *p, int width, int height, int storage, int isa);
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
