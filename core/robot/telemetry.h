/* What the robot says over a serial line: one frame for each picture it looked at, now and then one about itself.
 *
 * docs/telemetry.md describes the frames byte by byte; `lobula run serial:PORT` reads them. 46 bytes a picture: at 30 Hz
 * an eighth of what 115200 baud carry. The network does not need it.
 *
 *     lobula_telemetry_init(&line, &about);                       once
 *     lobula_telemetry_put(&line, &told);                         after each picture: never waits
 *     while (uart_is_free() && (byte = lobula_telemetry_next(&line)) >= 0) uart_send((uint8_t)byte);
 *
 * `put` may be called by the main loop and `next` by an interrupt of the same processor.
 */
#ifndef LOBULA_TELEMETRY_H
#define LOBULA_TELEMETRY_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LOBULA_TELEMETRY_VERSION 1
#define LOBULA_TELEMETRY_READING_BYTES 46 /* on the line */
#define LOBULA_TELEMETRY_HELLO_BYTES 78
#define LOBULA_TELEMETRY_HELLO_EVERY 32 /* readings; the first hello comes before the first of them */
#define LOBULA_TELEMETRY_ROOM 128       /* bytes that may wait: a hello and a reading, and a power of two */

/* What the wheels do. A robot without wheels of its own says so. */
enum {
    LOBULA_TELEMETRY_FORWARD = 0,
    LOBULA_TELEMETRY_STOP = 1,
    LOBULA_TELEMETRY_TURN_LEFT = 2,
    LOBULA_TELEMETRY_TURN_RIGHT = 3,
    LOBULA_TELEMETRY_NO_MOTOR = 255
};

/* Of one picture; neurons in the order lgmd1, lgmd2, lptc_r, lptc_l. */
typedef struct {
    uint32_t frame;      /* number of the picture since the robot was switched on: each larger than the one before */
    uint32_t time_ms;    /* when it was taken, by the robot's own clock, which may wrap */
    float potentials[4]; /* as the network gave them */
    int32_t spikes[4];   /* more than 255 are told as 255 */
    int32_t state;       /* LOBULA_STATE_... */
    int32_t collision;   /* 0 or 1 */
    int32_t action;      /* LOBULA_TELEMETRY_FORWARD ... */
    uint32_t step_us;    /* how long the network took; 0 where nobody measures */
} lobula_telemetry_reading;

/* Of the robot. Texts are ASCII; of one that is too long its beginning is told. */
typedef struct {
    uint16_t width, height; /* working size */
    uint8_t neurons;        /* who decides: 0 all, 1 lgmds, 2 lgmd2 */
    float rate_hz;          /* pictures a second, as intended */
    float thresholds[4];    /* potential at which each neuron starts to spike, below 0 for lptc_l */
    const char *settings_hash; /* 12 hexadecimal digits */
    const char *preset;        /* at most 16 characters */
    const char *version;       /* of lobula, at most 16 characters */
} lobula_telemetry_hello;

/* A line: what waits to be sent, and what is counted. */
typedef struct {
    const lobula_telemetry_hello *hello;
    uint16_t sequence;
    uint8_t until_hello;
    volatile uint8_t begin, end; /* of what waits; each written by one side only */
    volatile uint8_t waiting[LOBULA_TELEMETRY_ROOM];
} lobula_telemetry;

/* Nothing waits. `hello` must stay where it is. */
void lobula_telemetry_init(lobula_telemetry *line, const lobula_telemetry_hello *hello);

/* Let a reading wait to be sent, after a hello if it is time for one. Returns 0 where there is no room, since the line is
 * too slow or is not emptied: the reading is left out, and its number with it, so that the other side counts it. */
int lobula_telemetry_put(lobula_telemetry *line, const lobula_telemetry_reading *reading);

/* The next byte to send, 0..255, or -1 while there is none. */
int lobula_telemetry_next(lobula_telemetry *line);

/* The frames alone, for those who send by other means. */
void lobula_telemetry_encode_reading(const lobula_telemetry_reading *reading, uint16_t sequence,
                                     uint8_t out[LOBULA_TELEMETRY_READING_BYTES]);
void lobula_telemetry_encode_hello(const lobula_telemetry_hello *hello, uint8_t out[LOBULA_TELEMETRY_HELLO_BYTES]);

#ifdef __cplusplus
}
#endif
#endif
