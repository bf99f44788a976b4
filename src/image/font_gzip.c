#include "image/font_internal.h"

#include "base/error.h"
#include "base/text.h"

#include <string.h>
#include <zlib.h>

#define STEP ((size_t)1 << 16)

bool wr_font_gunzip(const uint8_t *bytes, size_t length, size_t limit, uint8_t **out, size_t *count,
                    WrError *err)
{
    z_stream z = { .next_in = (Bytef *)(uintptr_t)bytes, .avail_in = (uInt)length };
    WrText text = { 0 };
    char *step = wr_alloc(STEP, 1);
    int state = inflateInit2(&z, 15 + 16); /* gzip only */
    bool started = state == Z_OK;
    while (state == Z_OK && text.length <= limit) {
        z.next_out = (Bytef *)step;
        z.avail_out = STEP;
        state = inflate(&z, Z_NO_FLUSH);
        if (state == Z_OK || state == Z_STREAM_END) wr_text_add_n(&text, step, STEP - z.avail_out);
    }
    if (started) inflateEnd(&z);
    wr_free(step);
    bool good = state == Z_STREAM_END && text.length <= limit && text.length > 0;
    if (good) {
        *count = text.length;
        *out = (uint8_t *)text.data;
        return true;
    }
    bool large = text.length > limit;
    wr_text_fini(&text);
    if (large) return wr_fail(err, "unpacks to more than %zu MB", limit >> 20);
    return wr_fail(err, "its gzip packing is damaged or cut off");
}
