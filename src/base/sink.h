/* sink.h - a destination of bytes with random access: what encoders and archives write to.
   Layer 0. C and C++. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrByteSink {
    /* All of the bytes, at an offset that may lie before or behind the end; false and errno. */
    bool (*write)(void *to, const void *bytes, size_t length, int64_t at);
    void *to; /* the caller's */
} WrByteSink;
