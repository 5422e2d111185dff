/* Feeds recorded frames to the network on the emulated robot and writes down what it says and what it costs.
 *
 * Reads frames.bin: int32 count; for each frame int32 by_row, int32 turning, float dt_ms and the luma. Writes
 * answers.bin: what is in `head`; then an `answer` for each frame. */
#include <stdint.h>

#include "lobula.h"
#include "semihosting.h"

#define HOST __attribute__((section(".bss.host")))

typedef struct {
    uint32_t state_bytes, stack_bytes, loop_counted, loop_true, init_counted;
} head;

typedef struct {
    double time_s;
    float lgmd1, lgmd2, lptc_r, lptc_l;
    int32_t spikes[4], collision, state, returned;
    uint32_t counted; /* instructions */
} answer;

typedef struct {
    int32_t by_row, turning;
    float dt_ms;
} frame_head;

static lobula_state state;
HOST static uint8_t luma[LOBULA_WIDTH * LOBULA_HEIGHT];

/* SysTick at 25 MHz; with -icount shift=0 an instruction lasts 1 ns, so a tick is 40 of them. */
static volatile uint32_t *const systick = (volatile uint32_t *)0xe000e010u;
enum { CONTROL, RELOAD, VALUE, PER_TICK = 40 };

static void start_counter(void) {
    systick[RELOAD] = 0xffffffu;
    systick[VALUE] = 0;
    systick[CONTROL] = 5; /* on, the processor's clock, no interrupt */
}

static uint32_t counted_since(uint32_t before) { return ((before - systick[VALUE]) & 0xffffffu) * PER_TICK; }

/* 2 instructions a turn. */
static void loop(uint32_t turns) {
    __asm__ volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(turns) : : "cc");
}

extern uint32_t stack_low[], stack_top[];
enum { UNTOUCHED = 0x5eed5eed };

static void paint_stack(void) {
    uint32_t *here;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    for (uint32_t *at = stack_low; at < here; at++) *at = UNTOUCHED;
}

static uint32_t stack_used(void) {
    const uint32_t *at = stack_low;
    while (*at == UNTOUCHED) at++;
    return (uint32_t)((const char *)stack_top - (const char *)at);
}

static int answer_frame(const frame_head *f, answer *a) {
    lobula_reading r;
    lobula_set_turning(&state, f->turning);
    uint32_t before = systick[VALUE];
    if (f->by_row) {
        for (int y = 0; y < LOBULA_HEIGHT; y++) lobula_push_row(&state, luma + y * LOBULA_WIDTH);
        a->returned = lobula_end_frame(&state, f->dt_ms, &r);
    } else {
        a->returned = lobula_step(&state, luma, f->dt_ms, &r);
    }
    a->counted = counted_since(before);
    a->time_s = r.time_s;
    a->lgmd1 = r.lgmd1, a->lgmd2 = r.lgmd2, a->lptc_r = r.lptc_r, a->lptc_l = r.lptc_l;
    for (int i = 0; i < 4; i++) a->spikes[i] = r.spikes[i];
    a->collision = r.collision, a->state = r.state;
    return a->returned >= 0;
}

int main(void) {
    int in = host_open("frames.bin", HOST_READ), out = host_open("answers.bin", HOST_WRITE), ok = in >= 0 && out >= 0;
    int32_t count = 0;
    head h = {.state_bytes = sizeof state, .loop_true = 2000000};
    paint_stack();
    start_counter();
    uint32_t before = systick[VALUE];
    loop(h.loop_true / 2);
    h.loop_counted = counted_since(before);
    before = systick[VALUE];
    ok = ok && lobula_init(&state) == LOBULA_OK;
    h.init_counted = counted_since(before);
    ok = ok && host_read(in, &count, sizeof count) && host_write(out, &h, sizeof h);
    for (int32_t i = 0; ok && i < count; i++) {
        frame_head f;
        answer a = {0};
        ok = host_read(in, &f, sizeof f) && host_read(in, luma, sizeof luma) && answer_frame(&f, &a) &&
             host_write(out, &a, sizeof a);
    }
    h.stack_bytes = stack_used();
    ok = ok && host_write(out, &h, sizeof h);
    host_close(out);
    host_exit(ok ? 0 : 1);
    return 0;
}
