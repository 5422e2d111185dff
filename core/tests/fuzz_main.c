/* Feed the fuzz entry from a seeded generator: fuzz RUNS [FIRST]. A run that fails is told by its number, and
 * `fuzz 1 NUMBER` repeats it alone. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int main(int argc, char **argv) {
    long runs = argc > 1 ? atol(argv[1]) : 1000, first = argc > 2 ? atol(argv[2]) : 0;
    for (long run = first; run < first + runs; run++) {
        uint8_t data[64];
        uint64_t state = (uint64_t)run * 0x9e3779b97f4a7c15u + 1;
        for (size_t i = 0; i < sizeof data; i++) {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            data[i] = (uint8_t)(state >> 32);
        }
        fprintf(stderr, "\rrun %ld", run);
        LLVMFuzzerTestOneInput(data, sizeof data);
    }
    fprintf(stderr, "\r");
    printf("fuzz: %ld runs good\n", runs);
    return 0;
}
