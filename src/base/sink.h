/* sink.h - a destination of bytes with random access, written by encoders and archives.

   For C and C++. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrByteSink {
    /* Writes all bytes at an offset, which may be before or beyond the end; on failure false and errno. */
    bool (*write)(void *to, const void *bytes, size_t length, int64_t at);
    void *to; /* context of the caller */
} WrByteSink;
