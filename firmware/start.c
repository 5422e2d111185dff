/* What a Cortex-M4F does before main. */
#include <stdint.h>

extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_top[];

int main(void);
void reset(void);

/* Anything unexpected ends here; QEMU then reports a lockup, and the test a timeout. */
static void stop(void) {
    for (;;) __asm__ volatile("bkpt #0");
}

void reset(void) {
    volatile uint32_t *access = (volatile uint32_t *)0xe000ed88u; /* CPACR: the floating point unit may be used */
    *access |= 0xfu << 20;
    __asm__ volatile("dsb\n isb");
    const uint32_t *from = data_load;
    for (uint32_t *to = data_start; to < data_end;) *to++ = *from++;
    for (uint32_t *to = bss_start; to < bss_end;) *to++ = 0;
    main();
    stop();
}

typedef struct {
    uint32_t *stack;
    void (*handlers[15])(void);
} vector_table;

__attribute__((section(".vectors"), used)) static const vector_table vectors = {
    stack_top, {reset, stop, stop, stop, stop, stop},
};
