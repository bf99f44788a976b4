/* fuzz_gbr.c - untrusted .gbr brushes: any bytes are refused with a message or give a tip with values in 0..1
   everywhere. The first byte's low bit makes the header start like a valid one, so that the following bytes are
   reached. */
#include "fuzz_tip.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t header[29] = { 0, 0, 0, 29, 0, 0,   0,   2,   0,   0, 0, 7, 0,  0, 0,
                                        5, 0, 0, 0,  1, 'G', 'I', 'M', 'P', 0, 0, 0, 20, 0 };
    uint8_t bytes[4096];
    if (size < 1 || size > sizeof bytes - sizeof header) return 0;
    size_t start = data[0] & 1 ? sizeof header : 0;
    memcpy(bytes, header, start);
    memcpy(bytes + start, data + 1, size - 1);
    check_tip(bytes, start + size - 1);
    return 0;
}
