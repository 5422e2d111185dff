/* An example: a robot that stops and turns away before something hits it.
 *
 * Here the camera is standard input, one byte a pixel, and the motors are lines of text. Put your own in the four
 * places marked with >>. */
#include <stdio.h>

#include "lobula.h"
#include "motor.h"

/* >> The next line of the camera, luminance 0..255; its length, less than a line where there is no more. */
static size_t next_line(uint8_t line[LOBULA_WIDTH]) { return fread(line, 1, LOBULA_WIDTH, stdin); }

int main(void) {
    static lobula_state state; /* static: larger than most stacks */
    static const char *const said[] = {"forward", "stop", "turn left", "turn right"};
    uint8_t line[LOBULA_WIDTH];
    float wheels_cm_s[2];
    lobula_reading r;
    lobula_motor motor;

    if (lobula_init(&state) != 0) return 1;
    lobula_motor_init(&motor, 1);
    puts("frame,lgmd1,lgmd2,lptc_r,lptc_l,spikes_lgmd1,spikes_lgmd2,spikes_lptc_r,spikes_lptc_l,collision,action,left,right");
    for (long frame = 0;; frame++) {
        lobula_begin_frame(&state); /* >> at the vertical sync; if none comes for half a second, stop the motors here */
        for (int row = 0; row < LOBULA_HEIGHT; row++) {
            const size_t length = next_line(line);
            if (length < LOBULA_WIDTH) {
                if (row == 0 && length == 0) return 0;
                fprintf(stderr, "the last picture is cut off: pictures must be of %d x %d bytes\n", LOBULA_WIDTH, LOBULA_HEIGHT);
                return 1;
            }
            lobula_push_row(&state, line);
        }
        const float dt_ms = 1000.0f / 30.0f; /* >> from the vertical sync before to this one, by your timer */
        lobula_set_turning(&state, lobula_motor_pass(&motor, dt_ms));
        if (lobula_end_frame(&state, dt_ms, &r) < 0) continue; /* no time has passed, says the timer */
        lobula_motor_decide(&motor, r.collision);
        lobula_motor_wheels(&motor, 8.0f, 4.8f, wheels_cm_s); /* at 8 cm/s, wheels 4.8 cm apart */
        /* >> your motors instead of text */
        printf("%ld,%.9g,%.9g,%.9g,%.9g,%d,%d,%d,%d,%d,%s,%.2f,%.2f\n", frame, (double)r.lgmd1, (double)r.lgmd2,
               (double)r.lptc_r, (double)r.lptc_l, (int)r.spikes[0], (int)r.spikes[1], (int)r.spikes[2],
               (int)r.spikes[3], (int)r.collision, said[motor.action], (double)wheels_cm_s[0], (double)wheels_cm_s[1]);
    }
}
