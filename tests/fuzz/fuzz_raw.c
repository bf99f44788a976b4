/* fuzz_raw.c - untrusted elevations without a header: for any declared size and any bytes, they are refused with a
   message or decoded within bounds. The first byte selects the kind and the byte order, the second the length of the
   text with the size. */
#include "base/error.h"
#include "base/memory.h"
#include "generate/terrain.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char text[32] = "";
    if (size < 2 || (size_t)(data[1] % 16) > size - 2) return 0;
    WrRaw raw = { .kind = (WrRawKind)(data[0] % WR_RAW_COUNT), .big = data[0] & 0x80 };
    memcpy(text, data + 2, data[1] % 16);
    const uint8_t *bytes = data + 2 + data[1] % 16;
    size_t length = size - 2 - data[1] % 16;
    WrError err = { "" };
    if (!wr_raw_size(text, length, &raw, &err)) {
        if (!*err.text || raw.width || raw.height) abort();
        return 0;
    }
    size_t count = (size_t)raw.width * (size_t)raw.height;
    if (count * wr_raw_bytes(raw.kind) != length) abort();
    double *z = wr_alloc(count, sizeof *z);
    wr_raw_decode(&raw, bytes, z);
    for (size_t k = 0; k < count; k++)
        if (raw.kind != WR_RAW_F32 && !(z[k] >= -32768.0 && z[k] <= 65535.0)) abort();
    wr_free(z);
    return 0;
}
