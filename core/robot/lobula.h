/* lobula on a robot: four insect neurons that say, from one camera, that something is going to hit it.
 *
 * The settings and the size of the picture stand in lobula_config.h, which `lobula export c` writes. Everything lives in
 * one variable of a fixed size; nothing is allocated, and any number of them may run side by side.
 *
 *     static lobula_state state;
 *     lobula_reading reading;
 *     lobula_init(&state);
 *     for each frame:      lobula_step(&state, luma, dt_ms, &reading);
 *     or, line by line:    lobula_begin_frame(&state);
 *                          lobula_push_row(&state, line);  LOBULA_HEIGHT times, from the top
 *                          lobula_end_frame(&state, dt_ms, &reading);
 *     if (reading.collision) turn away;
 *
 * It is the same source that runs on the laptop, with float32 arithmetic and 16-bit planes: what the Python package
 * computes with Network(storage="compact"). */
#ifndef LOBULA_H
#define LOBULA_H

#include <stdint.h>

#include "lobula_config.h"
#include "lobula_sizes.h"
#include "lobula_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Everything a network remembers, and its room to work in. */
typedef struct {
    double time_s;
    int32_t rows, turning;
    uint32_t ready;
    union {
        double aligned;
        uint8_t bytes[LOBULA_MEMORY_BYTES];
    } memory;
} lobula_state;

/* Make the network ready for its first frame, or forget everything. LOBULA_BAD_ARGUMENT: the settings cannot be. */
int lobula_init(lobula_state *state);

/* Advance by one frame: LOBULA_HEIGHT rows of LOBULA_WIDTH bytes, luminance 0..255, row by row. `dt_ms` is the time
 * since the frame before (of the first frame: whatever). Returns reading->collision, 0 or 1; or an error below 0, and the
 * reading is as it was: LOBULA_BAD_STATE without lobula_init, LOBULA_BAD_ARGUMENT where a pointer is null, or dt_ms is not
 * above 0 or more than 1e9. */
int lobula_step(lobula_state *state, const uint8_t *luma, float dt_ms, lobula_reading *reading);

/* The same in parts. `begin` forgets the lines so far: call it at the camera's vertical sync, and a frame that was broken
 * off does not mix with the next; lobula_end_frame has done so too. A line may be used for something else as soon as
 * `push` returns, which tells how many are there, or an error below 0. More than LOBULA_HEIGHT are not looked at; those
 * that are missing at the end stay as in the frame before. Lines wait where `end` works: push none until it returns. */
void lobula_begin_frame(lobula_state *state);
int lobula_push_row(lobula_state *state, const uint8_t *row);
int lobula_end_frame(lobula_state *state, float dt_ms, lobula_reading *reading);

/* Say that the robot turns (1) or no longer does (0), before the frame that is taken meanwhile: nothing is decided
 * then, nor for LOBULA_DECISION_AFTER_TURN_MS more. */
void lobula_set_turning(lobula_state *state, int turning);

#ifdef __cplusplus
}
#endif
#endif
