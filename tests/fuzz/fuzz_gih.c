/* fuzz_gih.c - untrusted .gih brushes, as in fuzz_gbr.c: with the first byte's low bit the two lines are the fuzzer's
   and the pictures, one pixel each, are valid. */
#include "fuzz_tip.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t cell[30] = { 0, 0, 0, 29, 0, 0,   0,   2,   0,   0, 0, 1, 0,  0, 0,
                                      1, 0, 0, 0,  1, 'G', 'I', 'M', 'P', 0, 0, 0, 20, 0, 200 };
    uint8_t bytes[8192];
    if (size < 1 || size > 4096) return 0;
    memcpy(bytes, data + 1, size - 1);
    size_t length = size - 1;
    for (int i = 0; (data[0] & 1) && i < 8; i++, length += sizeof cell)
        memcpy(bytes + length, cell, sizeof cell);
    check_tip(bytes, length);
    return 0;
}
