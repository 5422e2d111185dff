/* Time rules: the rounding of a source's stamps moves no step, no limit and no decision. Expected values by hand. */
#include "check.h"
#include "clock.h"
#include "decision.h"

enum { FRAMES = 120, HABITS = 4 };

/* Frame `k` at `hz` as programs write it: multiplied, summed up, in whole ms, in whole us. */
static double stamp(double hz, int k, int habit) {
    if (habit == 1) {
        double sum = 0.0;
        for (int i = 0; i < k; i++) sum += 1.0 / hz;
        return sum;
    }
    double unit = habit == 2 ? 1e3 : habit == 3 ? 1e6 : 0.0, exact = k / hz;
    return unit > 0.0 ? (double)(long long)(exact * unit + 0.5) / unit : exact;
}

static void quarters(void) {
    const double told[][2] = {{1.0, 1.0}, {0.999, 1.0}, {1.099, 1.0}, {1.101, 1.25}, {1.2, 1.25}, {2.5, 2.5}, {0.09, 0.0}};
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        CHECK(whole_quarters(told[i][0]) == told[i][1], "ticks in whole quarters");
}

/* Of `frames` the first starts, then each `every`-th is a tick. */
static void ticks(const lobula_clock_params *p, double hz, int every) {
    for (int habit = 0; habit < HABITS; habit++) {
        lobula_scalars now = {0};
        for (int k = 0; k < FRAMES; k++) {
            beat expected = k == 0 ? BEAT_START : k % every ? BEAT_WAIT : BEAT_TICK;
            CHECK(clock_beat(p, &now, stamp(hz, k, habit)) == expected, "which frames are ticks");
        }
    }
}

/* At 30 Hz a repeat is held up to 200 ms, six frames; the seventh is a still scene and so are those after it. */
static void repeats(const lobula_clock_params *p) {
    for (int habit = 0; habit < HABITS; habit++) {
        lobula_scalars now = {0};
        for (int k = 0; k < 12; k++) {
            double t = stamp(30.0, k, habit);
            if (clock_beat(p, &now, t) == BEAT_TICK)
                CHECK((clock_advances(p, &now, t, 0.0, 0.0) < 0.0) == (k <= 6), "how long a repeat is held");
        }
    }
}

/* Two spikes at 0 and two at frame `gap` meet while they lie within 200 ms less one; a collision lasts as long. */
static void decisions(const lobula_params *p, double hz, int frames_of_200_ms) {
    const int32_t two[4] = {2, 2, 0, 0};
    for (int habit = 0; habit < HABITS; habit++)
        for (int gap = 1; gap <= frames_of_200_ms + 1; gap++) {
            network_state *s = memory(lobula_state_size(p, 32, 24, LOBULA_FLOAT));
            CHECK(lobula_init(s, p, 32, 24, LOBULA_FLOAT, LOBULA_ISA_AUTO) == LOBULA_OK, "a network");
            decision_step(s, stamp(hz, 0, habit), two, 1.0);
            decision_step(s, stamp(hz, gap, habit), two, 1.0);
            for (int k = gap; k < gap + 12; k++) {
                int expected = gap < frames_of_200_ms && k < gap + frames_of_200_ms;
                CHECK(decision_collision(s, stamp(hz, k, habit)) == expected, "a collision, and how long it lasts");
            }
            free(s);
        }
}

int main(void) {
    lobula_params p = published();
    quarters();
    ticks(&p.clock, 15.0, 1);
    ticks(&p.clock, 30.0, 1);
    ticks(&p.clock, 45.0, 1); /* 22.2 and 44.4 ms are as near to 33.3: the first of them */
    ticks(&p.clock, 60.0, 2);
    ticks(&p.clock, 75.0, 2); /* likewise 26.7 and 40 */
    ticks(&p.clock, 120.0, 4);
    repeats(&p.clock);
    decisions(&p, 15.0, 3);
    decisions(&p, 20.0, 4);
    decisions(&p, 25.0, 5);
    decisions(&p, 30.0, 6);
    puts("time: good");
    return 0;
}
