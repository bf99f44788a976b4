/* fuzz_gbr.c - .gbr brushes from strangers: whatever the bytes, they are refused with a message or give a
   tip whose values lie in 0..1 wherever it is asked. The first byte's low bit makes the header begin as a
   true one does, so that the bytes behind it are reached. */
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
