/* A whole robot, to see how large it is: camera lines in; network, wheels and serial line at work. The registers are
 * invented (a flag is down again once it was read); the program is linked, not run. */
#include "lobula.h"
#include "motor.h"
#include "telemetry.h"

typedef struct {
    uint32_t frame_begins, line_ready, now_us, now_ms, uart_free, uart, wheel[2];
    uint8_t line[LOBULA_WIDTH];
} board;

static volatile board *const robot = (volatile board *)0x40000000u;

static lobula_state network;
static lobula_motor motor;
static lobula_telemetry line;

enum { STALLED_US = 500000 };

static void drive(const float wheels_cm_s[2]) {
    for (int i = 0; i < 2; i++) robot->wheel[i] = (uint32_t)(int32_t)(wheels_cm_s[i] * 100.0f);
}

/* While it waits for the camera: the serial line takes what it can, and wheels do not go on blindly. */
static void meanwhile(uint32_t before_us) {
    static const float still[2] = {0.0f, 0.0f};
    for (int byte; robot->uart_free && (byte = lobula_telemetry_next(&line)) >= 0;) robot->uart = (uint32_t)byte;
    if (robot->now_us - before_us > STALLED_US) drive(still);
}

static void take_picture(uint32_t before_us) {
    uint8_t row[LOBULA_WIDTH];
    for (int rows = 0; rows < LOBULA_HEIGHT;) {
        meanwhile(before_us);
        if (robot->frame_begins) lobula_begin_frame(&network);
        if (!robot->line_ready) continue;
        for (int x = 0; x < LOBULA_WIDTH; x++) row[x] = robot->line[x];
        rows = lobula_push_row(&network, row);
    }
}

static void tell(uint32_t frame, uint32_t time_ms, const lobula_reading *r, uint32_t step_us) {
    lobula_telemetry_reading told = {
        frame, time_ms, {r->lgmd1, r->lgmd2, r->lptc_r, r->lptc_l},
        {r->spikes[0], r->spikes[1], r->spikes[2], r->spikes[3]},
        r->state, r->collision, (int32_t)motor.action, step_us};
    lobula_telemetry_put(&line, &told);
}

int main(void) {
    static const lobula_telemetry_hello about = {
        LOBULA_WIDTH, LOBULA_HEIGHT, LOBULA_DECISION_NEURONS, 30.0f,
        {LOBULA_LGMD1_SPIKING_THRESHOLD, LOBULA_LGMD2_SPIKING_THRESHOLD, LOBULA_LPTC_SPIKING_THRESHOLD,
         -LOBULA_LPTC_SPIKING_THRESHOLD},
        LOBULA_SETTINGS_HASH, LOBULA_PRESET, LOBULA_VERSION};
    lobula_reading reading;
    float wheels_cm_s[2];
    if (lobula_init(&network) != LOBULA_OK) return 1;
    lobula_motor_init(&motor, 1);
    lobula_telemetry_init(&line, &about);
    uint32_t before_us = robot->now_us;
    for (uint32_t frame = 0;; frame++) {
        take_picture(before_us);
        const uint32_t here_us = robot->now_us;
        const float dt_ms = (float)(here_us - before_us) * 1e-3f; /* unsigned: right when the timer wraps */
        lobula_set_turning(&network, lobula_motor_pass(&motor, dt_ms));
        if (lobula_end_frame(&network, dt_ms, &reading) < 0) continue;
        before_us = here_us;
        lobula_motor_decide(&motor, reading.collision);
        lobula_motor_wheels(&motor, 8.0f, 4.8f, wheels_cm_s);
        drive(wheels_cm_s);
        tell(frame, robot->now_ms, &reading, robot->now_us - here_us);
    }
}
