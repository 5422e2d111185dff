/* The robot's way in: fixed settings, fixed memory, one frame at a time. */
#include "lobula.h"

#include <string.h>

#include "network.h"

#define INHIBITION(NAME)                                                                                            \
    {LOBULA_##NAME##_CENTRE_WEIGHT, LOBULA_##NAME##_NEAREST_WEIGHT, LOBULA_##NAME##_DIAGONAL_WEIGHT,                \
     LOBULA_##NAME##_CENTRE_MS, LOBULA_##NAME##_NEAREST_MS, LOBULA_##NAME##_DIAGONAL_MS, LOBULA_##NAME##_BIAS}

#define LGMD(NAME)                                                                                                  \
    {.reads = LOBULA_##NAME##_READS,                                                                                \
     .on = INHIBITION(NAME##_ON),                                                                                   \
     .off = INHIBITION(NAME##_OFF),                                                                                 \
     .neighbour_px = LOBULA_##NAME##_NEIGHBOUR_PX,                                                                  \
     .change_scale_grey = LOBULA_##NAME##_CHANGE_SCALE_GREY,                                                        \
     .change_ms = LOBULA_##NAME##_CHANGE_MS,                                                                        \
     .on_gain = LOBULA_##NAME##_ON_GAIN,                                                                            \
     .off_gain = LOBULA_##NAME##_OFF_GAIN,                                                                          \
     .product_gain = LOBULA_##NAME##_PRODUCT_GAIN,                                                                  \
     .grouping = {LOBULA_##NAME##_GROUPING_ENABLED, LOBULA_##NAME##_GROUPING_THRESHOLD_GREY,                        \
                  LOBULA_##NAME##_GROUPING_FLOOR_GREY, LOBULA_##NAME##_GROUPING_DIVISOR},                           \
     .coarse_gain = LOBULA_##NAME##_COARSE_GAIN,                                                                    \
     .coarse_on_weight = LOBULA_##NAME##_COARSE_ON_WEIGHT,                                                          \
     .sigmoid_grey = LOBULA_##NAME##_SIGMOID_GREY,                                                                  \
     .sfa = {LOBULA_##NAME##_SFA_ENABLED, LOBULA_##NAME##_SFA_TAU_MS, LOBULA_##NAME##_SFA_GROWTH},                  \
     .spiking = {LOBULA_##NAME##_SPIKING_GAIN, LOBULA_##NAME##_SPIKING_THRESHOLD}}

static const lobula_params settings = {
    .clock = {LOBULA_CLOCK_PERIOD_MS, LOBULA_CLOCK_CHANGE_EXPONENT, LOBULA_CLOCK_MAX_GAP_MS, LOBULA_CLOCK_REPEATS,
              LOBULA_CLOCK_REPEAT_HOLD_MS, LOBULA_CLOCK_REPEAT_MEAN_GREY, LOBULA_CLOCK_REPEAT_MAX_GREY},
    .flash = {LOBULA_FLASH_ENABLED, LOBULA_FLASH_MIN_CHANGE_GREY, LOBULA_FLASH_MIN_COVERAGE, LOBULA_FLASH_TRIM,
              LOBULA_FLASH_MIN_EXPLAINED, LOBULA_FLASH_MIN_GAIN, LOBULA_FLASH_MAX_GAIN},
    .saturation = {LOBULA_SATURATION_ENABLED, LOBULA_SATURATION_LIMIT_GREY},
    .coarse = {LOBULA_COARSE_PATCH_PX, LOBULA_COARSE_FLOOR_GREY},
    .lamina = {{LOBULA_LAMINA_DOG_ENABLED, LOBULA_LAMINA_DOG_RADIUS_PX, LOBULA_LAMINA_DOG_SIGMA_PX,
                LOBULA_LAMINA_DOG_SURROUND, LOBULA_LAMINA_DOG_DEAD_ZONE_GREY},
               {LOBULA_LAMINA_ON_OFF_RESIDUAL},
               {LOBULA_LAMINA_FDSR_ENABLED, LOBULA_LAMINA_FDSR_RISE_MS}},
    .lgmd1 = LGMD(LGMD1),
    .lgmd2 = LGMD(LGMD2),
    .lptc = {{LOBULA_LPTC_EMD_SPANS, LOBULA_LPTC_EMD_SPANS_PX, LOBULA_LPTC_EMD_DELAYS_MS},
             LOBULA_LPTC_SIGMOID_GREY2,
             {LOBULA_LPTC_SPIKING_GAIN, LOBULA_LPTC_SPIKING_THRESHOLD}},
    .decision = {LOBULA_DECISION_NEURONS, LOBULA_DECISION_WINDOW_MS, LOBULA_DECISION_COLLISION_SPIKES,
                 LOBULA_DECISION_LPTC_WEIGHT, LOBULA_DECISION_END_MS, LOBULA_DECISION_WARM_UP_MS,
                 LOBULA_DECISION_AFTER_TURN_MS},
};

extern const kernels kernels_base; /* sweep.c */

/* The header of lobula_sizes.h has room for the real one: else this array has a negative size. */
typedef char header_fits[sizeof(network_state) <= LOBULA_HEADER_BYTES ? 1 : -1];

enum { PICTURE_BYTES = LOBULA_WIDTH * LOBULA_HEIGHT };

#define READY 0x6c6f6275u /* not 1: a state that was never made may hold anything */
#define LONGEST_MS 1e9f   /* eleven days; only a timer that went wrong says more, and one such sum would spoil the time */

static network_state *network_of(lobula_state *state) { return (network_state *)(void *)state->memory.bytes; }

/* Lines wait for the end of their frame where the second list of grouped cells will end. It grows from the front by at
 * most 2 bytes for each cell of a row, and three rows behind the one that is read or more; so it gets there only after
 * what it overwrites has been read: 2 W (y - 2) <= W H + W y for every y < H. */
static uint8_t *waiting_lines(lobula_state *state) {
    return state->memory.bytes + LOBULA_MEMORY_BYTES - PICTURE_BYTES;
}

int lobula_init(lobula_state *state) {
    layout l;
    memset(state, 0, sizeof *state);
    if (layout_init(&l, &settings, LOBULA_WIDTH, LOBULA_HEIGHT, LOBULA_COMPACT) != LOBULA_OK) return LOBULA_BAD_ARGUMENT;
    if (l.state_bytes > LOBULA_REMEMBERED_BYTES || kernels_base.scratch_bytes(&l) != LOBULA_WORKING_BYTES)
        return LOBULA_BAD_ARGUMENT; /* lobula_config.h contradicts itself */
    network_init(network_of(state), &settings, &l, 0, LOBULA_COMPACT);
    state->ready = READY;
    return LOBULA_OK;
}

static int take_in(lobula_state *state, const uint8_t *luma, float dt_ms, lobula_reading *reading) {
    network_state *s = network_of(state);
    call c = {.s = s, .k = &kernels_base, .e = {LOBULA_WIDTH, LOBULA_HEIGHT}, .frames = 1};
    picture image = {(const char *)luma, LOBULA_WIDTH, LOBULA_UINT8};
    if (state->ready != READY) return LOBULA_BAD_STATE;
    if (!luma || !reading) return LOBULA_BAD_ARGUMENT;
    if (s->now.has_frame) {
        if (!(dt_ms > 0.0f && dt_ms <= LONGEST_MS)) return LOBULA_BAD_ARGUMENT;
        state->time_s += (double)dt_ms / 1000.0;
    }
    c.workspace = (char *)state->memory.bytes + LOBULA_REMEMBERED_BYTES;
    network_frame(&c, image, state->time_s, state->turning, reading, NULL);
    network_flush(&c);
    return reading->collision;
}

int lobula_step(lobula_state *state, const uint8_t *luma, float dt_ms, lobula_reading *reading) {
    state->rows = 0;
    return take_in(state, luma, dt_ms, reading);
}

void lobula_begin_frame(lobula_state *state) { state->rows = 0; }

int lobula_push_row(lobula_state *state, const uint8_t *row) {
    if (state->ready != READY) return LOBULA_BAD_STATE;
    if (!row) return LOBULA_BAD_ARGUMENT;
    if (state->rows < LOBULA_HEIGHT) {
        memcpy(waiting_lines(state) + state->rows * LOBULA_WIDTH, row, LOBULA_WIDTH);
        state->rows++;
    }
    return state->rows;
}

int lobula_end_frame(lobula_state *state, float dt_ms, lobula_reading *reading) {
    network_state *s = network_of(state);
    for (int y = state->rows; state->ready == READY && y < LOBULA_HEIGHT; y++)
        memcpy(waiting_lines(state) + y * LOBULA_WIDTH, luma_row(&s->layout, state_planes(s), y), LOBULA_WIDTH);
    state->rows = 0;
    return take_in(state, waiting_lines(state), dt_ms, reading);
}

void lobula_set_turning(lobula_state *state, int turning) { state->turning = turning != 0; }
