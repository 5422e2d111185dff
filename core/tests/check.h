/* What the tests of the laptop's core share: memory as the core wants it, and one set of settings. */
#ifndef LOBULA_TESTS_CHECK_H
#define LOBULA_TESTS_CHECK_H

#define _POSIX_C_SOURCE 200112L /* posix_memalign; include this file first */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check_macro.h"
#include "lobula.h"

/* Aligned memory of exactly `bytes`, full of 0xa5: what reads before it writes gives itself away. */
static inline void *memory(size_t bytes) {
    void *raw = NULL;
    if (bytes == 0 || posix_memalign(&raw, LOBULA_ALIGN, bytes) != 0) {
        fprintf(stderr, "no memory for %zu bytes\n", bytes);
        abort();
    }
    memset(raw, 0xa5, bytes);
    return raw;
}

/* The preset `published`: src/lobula/model/presets.py and the defaults beside each parameter. */
static inline lobula_params published(void) {
    const lobula_inhibition_params slow = {1.0, 0.25, 0.125, 60.0, 120.0, 180.0, 0.5};
    const lobula_inhibition_params fast = {2.0, 0.5, 0.25, 15.0, 30.0, 45.0, 1.0};
    const lobula_lgmd_params lgmd = {
        .reads = 0, .on = slow, .off = slow, .neighbour_px = 1, .change_scale_grey = 20.0, .change_ms = 10.0,
        .on_gain = 1.0, .off_gain = 1.0, .product_gain = 0.0, .grouping = {1, 30.0, 0.01, 4.0},
        .coarse_gain = 0.0, .coarse_on_weight = 5.0, .sigmoid_grey = 1.0, .sfa = {1, 800.0, 0.003}, .spiking = {4.0, 0.7}};
    lobula_params p = {
        .clock = {1000.0 / 30.0, 0.75, 500.0, 1, 200.0, 0.1, 8.0},
        .flash = {1, 1.0, 0.8, 3.0, 0.7, 0.2, 5.0},
        .saturation = {0, 35.0},
        .coarse = {9, 1.0},
        .lamina = {{1, 2, 2.0, 2, 1e-4}, {0.1}, {1, 1.0}},
        .lgmd1 = lgmd, .lgmd2 = lgmd,
        .lptc = {{4, {1, 2, 3, 4}, {40.0, 30.0, 20.0, 10.0}}, 0.01, {4.0, 0.2}},
        .decision = {0, 200.0, 4, 1.0, 200.0, 200.0, 67.0}};
    p.lgmd2.on = fast;
    p.lgmd2.change_ms = 90.0;
    p.lgmd2.product_gain = 1.0;
    return p;
}

/* A network with memory of its own, for blocks of `frames`, its planes kept in `storage`. */
static inline lobula_net network_in(int storage, const lobula_params *p, int width, int height, int frames) {
    lobula_net net = {memory(lobula_state_size(p, width, height, storage)),
                      memory(lobula_workspace_size(p, width, height, storage, frames))};
    CHECK(lobula_init(net.state, p, width, height, storage, LOBULA_ISA_AUTO) == LOBULA_OK,
          "a network that should be possible");
    return net;
}

static inline lobula_net network(const lobula_params *p, int width, int height, int frames) {
    return network_in(LOBULA_FLOAT, p, width, height, frames);
}

static inline void release(lobula_net *net) {
    free(net->state);
    free(net->workspace);
}

/* Side by side uint8 pictures, the usual case. */
static inline lobula_images bytes_of(const uint8_t *pixels, int width, int height) {
    lobula_images images = {pixels, width, (ptrdiff_t)width * height, LOBULA_UINT8, 0};
    return images;
}

#endif
