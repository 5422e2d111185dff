#include "semihosting.h"

#include <stdint.h>
#include <string.h>

/* Operations of Arm's semihosting, as the specification numbers them. */
enum { OPEN = 0x01, CLOSE = 0x02, WRITE = 0x05, READ = 0x06, EXIT_EXTENDED = 0x20 };

static int call(int operation, const void *arguments) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = arguments;
    __asm__ volatile("bkpt #0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

int host_open(const char *path, enum host_mode mode) {
    uintptr_t arguments[3] = {(uintptr_t)path, (uintptr_t)mode, strlen(path)};
    return call(OPEN, arguments);
}

int host_read(int file, void *to, size_t bytes) {
    uintptr_t arguments[3] = {(uintptr_t)file, (uintptr_t)to, bytes};
    return call(READ, arguments) == 0;
}

int host_write(int file, const void *from, size_t bytes) {
    uintptr_t arguments[3] = {(uintptr_t)file, (uintptr_t)from, bytes};
    return call(WRITE, arguments) == 0;
}

void host_close(int file) {
    uintptr_t arguments[1] = {(uintptr_t)file};
    call(CLOSE, arguments);
}

void host_exit(int status) {
    uintptr_t arguments[2] = {0x20026 /* the application's own end */, (uintptr_t)status};
    call(EXIT_EXTENDED, arguments);
}
