/* Files of the machine that runs the emulator. */
#ifndef LOBULA_SEMIHOSTING_H
#define LOBULA_SEMIHOSTING_H

#include <stddef.h>

enum host_mode { HOST_READ = 1, HOST_WRITE = 5 };

/* A handle, or -1. */
int host_open(const char *path, enum host_mode mode);
/* Whether all `bytes` were read, or written. */
int host_read(int file, void *to, size_t bytes);
int host_write(int file, const void *from, size_t bytes);
void host_close(int file);
/* End the emulation; its exit status is `status`. */
void host_exit(int status);

#endif
