/* model/clock.py: what a frame's own stamp means to a model that is defined at 30 steps a second. */
#ifndef LOBULA_CLOCK_H
#define LOBULA_CLOCK_H

#include "real.h"

/* Stamps are rounded: limits in ms stand this much to the side, and of two frames as near to a tick's end the first is
 * taken. */
#define SLACK_MS 1.0
#define NEAREST 0.97

/* Ticks rounded to quarters, up from 0.4 of one: the same for each step of a steady source, however it rounds. */
real whole_quarters(real ticks);

typedef enum { BEAT_START, BEAT_WAIT, BEAT_TICK } beat;

/* What the frame stamped `time_s` is; remembers it. */
beat clock_beat(const lobula_clock_params *p, lobula_scalars *now, double time_s);

/* The step's length in ms, or a negative number where the frame only repeats the one before. */
double clock_advances(const lobula_clock_params *p, lobula_scalars *now, double time_s, real mean_abs, real max_abs);

#endif
