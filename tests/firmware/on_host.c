/* The robot's build on the machine of the tests: frames from standard input, readings to standard output.
 *
 * In: for each frame int32 by_row, int32 turning, float dt_ms, then the luma. Out: a lobula_reading each. */
#include <stdio.h>

#include "lobula.h"

static lobula_state state;
static uint8_t luma[LOBULA_WIDTH * LOBULA_HEIGHT];

int main(void) {
    struct {
        int32_t by_row, turning;
        float dt_ms;
    } f;
    if (lobula_init(&state) != LOBULA_OK) return 2;
    while (fread(&f, sizeof f, 1, stdin) == 1 && fread(luma, sizeof luma, 1, stdin) == 1) {
        lobula_reading r;
        lobula_set_turning(&state, f.turning);
        if (f.by_row) {
            for (int y = 0; y < LOBULA_HEIGHT; y++) lobula_push_row(&state, luma + y * LOBULA_WIDTH);
            lobula_end_frame(&state, f.dt_ms, &r);
        } else {
            lobula_step(&state, luma, f.dt_ms, &r);
        }
        if (fwrite(&r, sizeof r, 1, stdout) != 1) return 3;
    }
    return 0;
}
