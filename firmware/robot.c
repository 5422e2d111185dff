/* A whole robot, to see how large it is: camera lines in; network, wheels and serial line at work. The registers are
 * invented; the program is linked, not run. */
#include "lobula.h"
#include "motor.h"
#include "telemetry.h"

typedef struct {
    uint32_t line_ready, frame_end, since_last_us, uart_free, uart, wheel[2];
    uint8_t line[LOBULA_WIDTH];
} board;

static volatile board *const robot = (volatile board *)0x40000000u;

static lobula_state network;
static lobula_motor motor;
static lobula_telemetry line;

static void tell(uint32_t frame, const lobula_reading *r, uint32_t step_us) {
    lobula_telemetry_reading told = {
        frame, (uint32_t)(r->time_s * 1000.0), {r->lgmd1, r->lgmd2, r->lptc_r, r->lptc_l},
        {r->spikes[0], r->spikes[1], r->spikes[2], r->spikes[3]},
        r->state, r->collision, (int32_t)motor.action, step_us};
    lobula_telemetry_put(&line, &told);
    for (int byte; robot->uart_free && (byte = lobula_telemetry_next(&line)) >= 0;) robot->uart = (uint32_t)byte;
}

int main(void) {
    static const lobula_telemetry_hello about = {
        LOBULA_WIDTH, LOBULA_HEIGHT, LOBULA_DECISION_NEURONS, 30.0f,
        {LOBULA_LGMD1_SPIKING_THRESHOLD, LOBULA_LGMD2_SPIKING_THRESHOLD, LOBULA_LPTC_SPIKING_THRESHOLD,
         -LOBULA_LPTC_SPIKING_THRESHOLD},
        LOBULA_SETTINGS_HASH, LOBULA_PRESET, LOBULA_VERSION};
    uint8_t row[LOBULA_WIDTH];
    lobula_reading reading;
    lobula_init(&network);
    lobula_motor_init(&motor, 1);
    lobula_telemetry_init(&line, &about);
    for (uint32_t frame = 0;; frame++) {
        while (!robot->frame_end) {
            if (!robot->line_ready) continue;
            for (int x = 0; x < LOBULA_WIDTH; x++) row[x] = robot->line[x];
            lobula_push_row(&network, row);
        }
        float dt_ms = (float)robot->since_last_us / 1000.0f, wheels[2];
        lobula_set_turning(&network, lobula_motor_pass(&motor, dt_ms));
        lobula_end_frame(&network, dt_ms, &reading);
        lobula_motor_decide(&motor, reading.collision);
        lobula_motor_wheels(&motor, 8.0f, 4.8f, wheels);
        for (int i = 0; i < 2; i++) robot->wheel[i] = (uint32_t)(int32_t)(wheels[i] * 100.0f);
        tell(frame, &reading, 0);
    }
}
