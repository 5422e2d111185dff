/* A check that says where and what. */
#ifndef LOBULA_TESTS_CHECK_MACRO_H
#define LOBULA_TESTS_CHECK_MACRO_H

#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition, message)                                                                     \
    do {                                                                                              \
        if (!(condition)) {                                                                           \
            fprintf(stderr, "%s:%d: %s: not so: %s\n", __FILE__, __LINE__, message, #condition);          \
            abort();                                                                                  \
        }                                                                                             \
    } while (0)

#endif
