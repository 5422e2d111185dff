/* What the wheels do on an alarm, as the paper's Algorithm 1 has it: stop, turn to the left or right, drive on.
 *
 * A motor queue holds nothing, or a stop and a turn in place; while it holds something, decisions are ignored. Optional:
 * the network does not need it. With each picture, `dt_ms` after the one before:
 *
 *     int turning = lobula_motor_pass(&motor, dt_ms);             before the network, which is told that it turns
 *     lobula_motor_decide(&motor, reading.collision);             after it
 *     lobula_motor_wheels(&motor, 8.0f, 4.8f, wheels_cm_s);       and so until the next picture
 *
 * The durations and angles are those of the simulated arena; define others before this file is read, or with -D.
 */
#ifndef LOBULA_MOTOR_H
#define LOBULA_MOTOR_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef LOBULA_MOTOR_STOP_MS
#define LOBULA_MOTOR_STOP_MS 200.0f /* standing still before the turn; published code: robot */
#endif
#ifndef LOBULA_MOTOR_TURN_MS
#define LOBULA_MOTOR_TURN_MS 800.0f /* length of the turn; published code: robot */
#endif
#ifndef LOBULA_MOTOR_LOW_DEG
#define LOBULA_MOTOR_LOW_DEG 120.0f /* smallest turn; the authors' group: 150 +- 30 degrees */
#endif
#ifndef LOBULA_MOTOR_HIGH_DEG
#define LOBULA_MOTOR_HIGH_DEG 180.0f /* largest turn */
#endif

/* where this does not compile: a turn takes time, LOBULA_MOTOR_TURN_MS must be 1 or more */
typedef char lobula_motor_turn_ms_is_1_or_more[(int)(LOBULA_MOTOR_TURN_MS) >= 1 ? 1 : -1];

typedef enum {
    LOBULA_MOTOR_FORWARD,
    LOBULA_MOTOR_STOP,
    LOBULA_MOTOR_TURN_LEFT,
    LOBULA_MOTOR_TURN_RIGHT
} lobula_motor_action;

typedef struct {
    lobula_motor_action action;
    float turn_deg_s;  /* rate of the present or coming turn; to the left is positive; 0 when the queue is empty */
    float elapsed_ms;  /* since the present action began */
    uint32_t chance;   /* angles and sides are drawn from it */
} lobula_motor;

/* Drive forward, the queue empty. The same `seed` gives the same turns: give each robot its own. */
void lobula_motor_init(lobula_motor *m, uint32_t seed);

/* `dt_ms` went by. Returns 1 while the queue holds something: `turning` of the network's step. */
int lobula_motor_pass(lobula_motor *m, float dt_ms);

/* Queue a stop and a turn if `avoid` says so and the queue is empty: on a collision alarm, or a bumper's contact.
 * Returns 1 where that was done. */
int lobula_motor_decide(lobula_motor *m, int avoid);

/* Speeds of the left and right wheel, which stand `track_cm` apart, of a robot that drives at `forward_cm_s`. */
void lobula_motor_wheels(const lobula_motor *m, float forward_cm_s, float track_cm, float wheels_cm_s[2]);

#ifdef __cplusplus
}
#endif
#endif
