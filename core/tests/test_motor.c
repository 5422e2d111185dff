/* The motor queue: how long each action lasts, what it ignores, where it turns. Expected numbers are worked by hand. */
#include "check.h"

#include <math.h>

#include "../robot/motor.h"

static lobula_motor fresh(uint32_t seed) {
    lobula_motor m;
    lobula_motor_init(&m, seed);
    return m;
}

/* Counts pictures until the action is no longer `action`. */
static int lasts(lobula_motor *m, lobula_motor_action action, float dt_ms) {
    int pictures = 0;
    while (m->action == action && pictures < 10000) {
        lobula_motor_pass(m, dt_ms);
        pictures++;
    }
    return pictures;
}

static void durations(float rate_hz, int stop, int turn) {
    lobula_motor m = fresh(1);
    CHECK(lobula_motor_pass(&m, 1000.0f / rate_hz) == 0, "nothing is queued at the start");
    CHECK(lobula_motor_decide(&m, 1) == 1, "an alarm");
    CHECK(m.action == LOBULA_MOTOR_STOP, "it stops at once");
    CHECK(lasts(&m, LOBULA_MOTOR_STOP, 1000.0f / rate_hz) == stop, "0.2 s of standing still");
    lobula_motor_action side = m.turn_deg_s > 0.0f ? LOBULA_MOTOR_TURN_LEFT : LOBULA_MOTOR_TURN_RIGHT;
    CHECK(m.action == side, "to the side that was drawn");
    CHECK(lasts(&m, side, 1000.0f / rate_hz) == turn, "0.8 s of turning");
    CHECK(m.action == LOBULA_MOTOR_FORWARD, "and on");
}

/* The queue says that it turns from the picture after the alarm to the last one before it drives on. */
static void turning_is_told(void) {
    lobula_motor m = fresh(2);
    lobula_motor_decide(&m, 1);
    for (int picture = 1; picture <= 32; picture++)
        CHECK(lobula_motor_pass(&m, 1000.0f / 30.0f) == (picture < 30), "29 pictures at 30 Hz");
}

static void decisions_are_ignored_meanwhile(void) {
    lobula_motor plain = fresh(3), pestered = fresh(3);
    CHECK(lobula_motor_decide(&plain, 0) == 0 && plain.action == LOBULA_MOTOR_FORWARD, "no alarm, no turn");
    lobula_motor_decide(&plain, 1);
    lobula_motor_decide(&pestered, 1);
    for (int picture = 1; picture < 30; picture++) {
        lobula_motor_pass(&plain, 1000.0f / 30.0f);
        lobula_motor_pass(&pestered, 1000.0f / 30.0f);
        CHECK(lobula_motor_decide(&pestered, 1) == 0, "the queue holds something");
        CHECK(memcmp(&plain, &pestered, sizeof plain) == 0, "nothing has changed");
    }
    lobula_motor_pass(&pestered, 1000.0f / 30.0f);
    CHECK(lobula_motor_decide(&pestered, 1) == 1, "the queue is empty again");
}

static void uneven_pictures(void) {
    lobula_motor m = fresh(4);
    float time_ms = 0.0f;
    lobula_motor_decide(&m, 1);
    for (int picture = 0; m.action == LOBULA_MOTOR_STOP; picture++) {
        float dt_ms = picture % 3 ? 25.0f : 40.0f;
        lobula_motor_pass(&m, dt_ms);
        time_ms += dt_ms;
    }
    CHECK(fabsf(time_ms - 200.0f) <= 20.0f, "as near to 0.2 s as the pictures allow");
    lobula_motor_pass(&m, 5000.0f);
    CHECK(m.action == LOBULA_MOTOR_FORWARD, "a camera that hung: the turn is over");
}

static void nonsense_passes_no_time(void) {
    const float nonsense[] = {0.0f, -40.0f, NAN, -INFINITY};
    lobula_motor m = fresh(5);
    lobula_motor_decide(&m, 1);
    for (int i = 0; i < 1000; i++) CHECK(lobula_motor_pass(&m, nonsense[i % 4]) == 1, "it still stands");
    CHECK(lasts(&m, LOBULA_MOTOR_STOP, 1000.0f / 30.0f) == 6, "and stops for 0.2 s of real time");
}

static void angles(void) {
    enum { DRAWS = 4000 };
    lobula_motor m = fresh(6);
    double sum = 0.0, least = 1e9, most = 0.0;
    int left = 0;
    for (int i = 0; i < DRAWS; i++) {
        lobula_motor_decide(&m, 1);
        double angle = (double)m.turn_deg_s * 0.8;
        left += angle > 0.0;
        angle = fabs(angle);
        sum += angle;
        if (angle < least) least = angle;
        if (angle > most) most = angle;
        lobula_motor_pass(&m, 1000.0f);
        lobula_motor_pass(&m, 1000.0f);
        CHECK(m.turn_deg_s == 0.0f, "no turn is left over");
    }
    CHECK(least >= 119.99 && least < 121.0 && most <= 180.01 && most > 179.0, "120 to 180 degrees, all of them");
    /* uniform over 60 degrees: standard error of the mean 60 / sqrt(12 * 4000) = 0.27; of the side 0.008 */
    CHECK(fabs(sum / DRAWS - 150.0) < 1.2, "150 degrees on average");
    CHECK(abs(left - DRAWS / 2) < 150, "either side as often");
}

static void robots_differ(void) {
    lobula_motor a = fresh(7), b = fresh(8), again = fresh(7);
    for (uint32_t seed = 0; seed < 100000; seed += 997) CHECK(fresh(seed).chance != 0, "a generator that moves");
    lobula_motor_decide(&a, 1);
    lobula_motor_decide(&b, 1);
    lobula_motor_decide(&again, 1);
    CHECK(a.turn_deg_s == again.turn_deg_s, "the same seed, the same turn");
    CHECK(a.turn_deg_s != b.turn_deg_s, "another seed, another turn");
}

static void wheels(void) {
    lobula_motor m = fresh(9);
    float v[2];
    lobula_motor_wheels(&m, 8.0f, 4.8f, v);
    CHECK(v[0] == 8.0f && v[1] == 8.0f, "straight on");
    m.action = LOBULA_MOTOR_STOP;
    lobula_motor_wheels(&m, 8.0f, 4.8f, v);
    CHECK(v[0] == 0.0f && v[1] == 0.0f, "still");
    m.action = LOBULA_MOTOR_TURN_LEFT;
    m.turn_deg_s = 180.0f; /* half a circle a second: each wheel goes pi * 2.4 cm = 7.540 cm in it */
    lobula_motor_wheels(&m, 8.0f, 4.8f, v);
    CHECK(fabsf(v[1] - 7.5398f) < 1e-3f && v[0] == -v[1], "to the left: the right wheel goes ahead, the left one back");
}

int main(void) {
    durations(25.0f, 5, 20);
    durations(30.0f, 6, 24);
    durations(40.0f, 8, 32);
    durations(120.0f, 24, 96);
    turning_is_told();
    decisions_are_ignored_meanwhile();
    uneven_pictures();
    nonsense_passes_no_time();
    angles();
    robots_differ();
    wheels();
    puts("motor: good");
    return 0;
}
