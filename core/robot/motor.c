#include "motor.h"

#define RAD_PER_DEG 0.017453293f

/* Marsaglia's xorshift: 32 bits that never get stuck at anything but 0. */
static uint32_t draw(lobula_motor *m) {
    uint32_t x = m->chance;
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    m->chance = x;
    return x;
}

/* In [0, 1): 24 bits are what a float holds. */
static float uniform(lobula_motor *m) { return (float)(draw(m) >> 8) * (1.0f / 16777216.0f); }

static void begin(lobula_motor *m, lobula_motor_action action) {
    m->action = action;
    m->elapsed_ms = 0.0f;
}

static void begin_turn(lobula_motor *m) {
    begin(m, m->turn_deg_s > 0.0f ? LOBULA_MOTOR_TURN_LEFT : LOBULA_MOTOR_TURN_RIGHT);
}

void lobula_motor_init(lobula_motor *m, uint32_t seed) {
    m->chance = (seed * 2654435761u) ^ 2463534242u; /* seeds next to each other go different ways */
    if (m->chance == 0u) m->chance = 1u;
    m->turn_deg_s = 0.0f;
    begin(m, LOBULA_MOTOR_FORWARD);
}

int lobula_motor_pass(lobula_motor *m, float dt_ms) {
    if (m->action == LOBULA_MOTOR_FORWARD || !(dt_ms > 0.0f)) return m->action != LOBULA_MOTOR_FORWARD;
    m->elapsed_ms += dt_ms;
    const float nearest_ms = m->elapsed_ms + 0.5f * dt_ms; /* an action ends with the picture nearest to its end */
    if (m->action == LOBULA_MOTOR_STOP) {
        if (nearest_ms >= LOBULA_MOTOR_STOP_MS) begin_turn(m);
    } else if (nearest_ms >= LOBULA_MOTOR_TURN_MS) {
        m->turn_deg_s = 0.0f;
        begin(m, LOBULA_MOTOR_FORWARD);
    }
    return m->action != LOBULA_MOTOR_FORWARD;
}

int lobula_motor_decide(lobula_motor *m, int avoid) {
    if (!avoid || m->action != LOBULA_MOTOR_FORWARD) return 0;
    const float low = LOBULA_MOTOR_LOW_DEG, high = LOBULA_MOTOR_HIGH_DEG;
    const float rate = (low + (high - low) * uniform(m)) * (1000.0f / LOBULA_MOTOR_TURN_MS);
    m->turn_deg_s = (draw(m) >> 31) ? rate : -rate;
    begin(m, LOBULA_MOTOR_STOP);
    if (LOBULA_MOTOR_STOP_MS <= 0.0f) begin_turn(m);
    return 1;
}

void lobula_motor_wheels(const lobula_motor *m, float forward_cm_s, float track_cm, float wheels_cm_s[2]) {
    const float ahead = m->action == LOBULA_MOTOR_FORWARD ? forward_cm_s : 0.0f;
    const int turns = m->action == LOBULA_MOTOR_TURN_LEFT || m->action == LOBULA_MOTOR_TURN_RIGHT;
    const float apart = turns ? m->turn_deg_s * RAD_PER_DEG * 0.5f * track_cm : 0.0f;
    wheels_cm_s[0] = ahead - apart;
    wheels_cm_s[1] = ahead + apart;
}
