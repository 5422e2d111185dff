/* The laptop's way in: a frame, or a block of frames, at a time. */
#include "float_mode.h"
#include "lobula.h"
#include "network.h"

static int enter(call *c, const lobula_net *net, const lobula_images *images, int frames) {
    if (!net || !net->state || !net->workspace || !images || !images->pixels || frames < 1) return LOBULA_BAD_ARGUMENT;
    if (images->type != LOBULA_UINT8 && images->type != LOBULA_FLOAT32) return LOBULA_BAD_ARGUMENT;
    network_state *s = net->state;
    if (s->magic != STATE_MAGIC || s->abi != LOBULA_ABI) return LOBULA_BAD_STATE;
    if (s->storage == LOBULA_COMPACT && images->type != LOBULA_UINT8) return LOBULA_BAD_ARGUMENT;
    c->s = s;
    c->k = kernels_of(s->isa, s->storage);
    c->workspace = net->workspace;
    c->e.width = s->layout.width;
    c->e.height = s->layout.height;
    c->frames = frames < MAX_FRAMES ? frames : MAX_FRAMES;
    c->waiting = 0;
    return c->k ? LOBULA_OK : LOBULA_BAD_STATE;
}

int lobula_step(const lobula_net *net, const lobula_images *image, double time_s, int turning, lobula_reading *reading,
                float *const *taps) {
    call c;
    int status = reading ? enter(&c, net, image, 1) : LOBULA_BAD_ARGUMENT;
    if (status != LOBULA_OK) return status;
    float_mode mode = float_mode_enter();
    picture p = {image->pixels, image->row_bytes, image->type};
    network_frame(&c, p, time_s, turning != 0, reading, taps);
    float_mode_leave(mode);
    return status;
}

int lobula_run(const lobula_net *net, const lobula_images *images, const double *times_s, const uint8_t *turning,
               int64_t count, int frames, lobula_reading *readings) {
    call c;
    int status = times_s && readings ? enter(&c, net, images, frames) : LOBULA_BAD_ARGUMENT;
    if (status != LOBULA_OK) return status;
    float_mode mode = float_mode_enter();
    for (int64_t t = 0; t < count; t++) {
        picture p = {(const char *)images->pixels + (ptrdiff_t)t * images->image_bytes, images->row_bytes, images->type};
        network_frame(&c, p, times_s[t], turning && turning[t], &readings[t], NULL);
    }
    network_flush(&c);
    float_mode_leave(mode);
    return LOBULA_OK;
}

int lobula_in_range(const lobula_images *image, int width, int height) {
    if (!image || !image->pixels) return 0;
    picture p = {image->pixels, image->row_bytes, image->type};
    extent e = {width, height};
    return image->type == LOBULA_UINT8 || kernels_of(lobula_isa_best(), LOBULA_FLOAT)->in_range(e, p);
}
