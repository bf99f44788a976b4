/* Number of distinct values of a picture, and the fewest bits that represent them. */
#include "export/check_internal.h"

#include "base/memory.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

#define ENOUGH 8 /* minimum of values besides black and white for detecting their step */

/* True if every code is one of `bits` bits, spread over all of `total` bits. */
static bool spread(const bool *seen, int total, int bits)
{
    const double last = (1 << total) - 1, few = (1 << bits) - 1;
    for (int c = 0; c < 1 << total; c++)
        if (seen[c] && floor(floor(c * few / last + 0.5) * last / few + 0.5) != c) return false;
    return true;
}

/* True if every code has `bits` bits and zeros below. */
static bool shifted(const bool *seen, int total, int bits)
{
    for (int c = 0; c < 1 << total; c++)
        if (seen[c] && c & ((1 << (total - bits)) - 1)) return false;
    return true;
}

static size_t texels_of(const WrCheckPicture *p)
{
    return (size_t)p->image->width * (size_t)p->image->height;
}

static const float *texel_of(const WrCheckPicture *p, size_t i)
{
    return p->image->data + i * (size_t)p->image->channels;
}

static void count_codes(const WrCheckPicture *p, int total, WrCheckNumbers *n)
{
    bool *seen = wr_alloc(WR_CHECK_DISTINCT, sizeof *seen);
    const int last = (1 << total) - 1;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            const int code = (int)((double)texel_of(p, i)[c] * last + 0.5);
            seen[code < 0 ? 0 : code > last ? last : code] = true;
        }
    for (int c = 0; c <= last; c++) n->distinct += seen[c];
    n->judged = n->distinct - seen[0] - seen[last] >= ENOUGH;
    n->bits = 1;
    while (n->judged && n->bits < total && !spread(seen, total, n->bits) &&
           !shifted(seen, total, n->bits))
        n->bits++;
    if (!n->judged) n->bits = total;
    wr_free(seen);
}

/* ---- floats ---- */

/* Hash set of numbers by their bits, limited to WR_CHECK_DISTINCT. Slots contain bits + 1, 0: empty. */
typedef struct Set {
    uint64_t *slot; /* [2 * WR_CHECK_DISTINCT] */
    int count;
} Set;

static uint32_t bits_of(float x)
{
    uint32_t bits;
    x += 0.0f; /* -0 becomes 0 */
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void add(Set *set, float x)
{
    const uint32_t bits = bits_of(x), mask = 2 * WR_CHECK_DISTINCT - 1;
    if (set->count == WR_CHECK_DISTINCT) return;
    uint32_t at = (bits * 0x9e3779b1u) >> 15 & mask;
    while (set->slot[at] && set->slot[at] != (uint64_t)bits + 1) at = (at + 1) & mask;
    set->count += !set->slot[at];
    set->slot[at] = (uint64_t)bits + 1;
}

/* True if half precision represents it: 11 digits; below 2^-14 multiples of 2^-24. */
static bool is_half(float x)
{
    const double size = fabs((double)x);
    if (size > 65504) return false;
    return size < 0x1p-14 ? size * 0x1p24 == floor(size * 0x1p24) : (bits_of(x) & 0x1fff) == 0;
}

/* True if it is a code k of 0..last stored as a float k/last, up to rounding. */
static bool is_code(float x, double last)
{
    const double code = (double)x * last;
    return code >= 0 && code <= last && fabs(code - floor(code + 0.5)) <= last * 0x1p-22;
}

static void count_floats(const WrCheckPicture *p, WrCheckNumbers *n)
{
    Set set = { wr_alloc((size_t)2 * WR_CHECK_DISTINCT, sizeof *set.slot), 0 };
    bool eight = true, sixteen = true, half = true;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            const float x = texel_of(p, i)[c];
            add(&set, x);
            half = half && is_half(x);
            eight = eight && is_code(x, 255);
            sixteen = sixteen && is_code(x, 65535);
        }
    n->distinct = set.count;
    n->judged = set.count >= ENOUGH + 2;
    n->half = n->judged && half;
    n->bits = !n->judged ? 32 : eight ? 8 : sixteen || half ? 16 : 32;
    wr_free(set.slot);
}

/* ---- whole picture ---- */

static void find_range(const WrCheckPicture *p, WrCheckNumbers *n)
{
    n->low = INFINITY, n->high = -INFINITY;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            n->low = fmin(n->low, (double)texel_of(p, i)[c]);
            n->high = fmax(n->high, (double)texel_of(p, i)[c]);
        }
}

static void count_ends(const WrCheckPicture *p, WrCheckNumbers *n)
{
    int64_t low = 0, high = 0;
    for (size_t i = 0; i < texels_of(p); i++)
        for (int c = 0; c < p->colours; c++) {
            low += (double)texel_of(p, i)[c] <= n->low;
            high += (double)texel_of(p, i)[c] >= n->high;
        }
    const double all = (double)texels_of(p) * p->colours;
    n->at_low = (double)low / all;
    n->at_high = (double)high / all;
}

void wr_check_numbers(const WrCheckPicture *picture, WrCheckNumbers *numbers)
{
    *numbers = (WrCheckNumbers){ 0 };
    find_range(picture, numbers);
    count_ends(picture, numbers);
    if (picture->image->type == WR_PIXEL_F32) count_floats(picture, numbers);
    else count_codes(picture, picture->image->type == WR_PIXEL_U8 ? 8 : 16, numbers);
}

double wr_check_step(const WrCheckNumbers *numbers)
{
    const double size = fmax(fabs(numbers->low), fabs(numbers->high));
    if (numbers->bits < 32 && !numbers->half) return 1.0 / ((1 << numbers->bits) - 1);
    return numbers->half ? size * 0x1p-11 : 0;
}
