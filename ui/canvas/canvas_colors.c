#include "ui/canvas/canvas_colors.h"

#include "field/field.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define BEYOND 0.01f /* of a code: tolerance before a value counts as beyond the range */
#define MAJOR 5      /* every fifth contour is a major one */
#define LINES 10     /* approximate number over the range */

static uint32_t mix(const double a[3], const double b[3], double t)
{
    uint32_t out = 0xff;
    for (int k = 0; k < 3; k++) out = out << 8 | (uint32_t)lrint(a[k] + t * (b[k] - a[k]));
    return out;
}

static void make_marks(WrCanvasInk *ink, bool marks)
{
    uint32_t *palette = ink->palette;
    bool sign = ink->colours == WR_CANVAS_SIGNED;
    palette[WR_CANVAS_INK_CODES] = !marks ? palette[0] : sign ? 0xff101f4au : 0xff1d4a78u;
    palette[WR_CANVAS_INK_CODES + 1] = !marks ? palette[WR_CANVAS_INK_CODES - 1]
                                       : sign ? 0xff6b2f05u
                                              : 0xfff0b070u;
}

/* With contours the greys are lighter and of lower contrast, so that the lines are visible. */
static uint32_t grey_of(int code, bool lined)
{
    uint32_t g = lined ? (uint32_t)(110 + code * 130 / 255) : (uint32_t)code;
    return 0xff000000u | g << 16 | g << 8 | g;
}

static void make_palette(WrCanvasInk *ink, bool marks)
{
    static const double blue[3] = { 38, 92, 190 }, white[3] = { 245, 245, 245 },
                        orange[3] = { 214, 112, 24 };
    for (int i = 0; i < WR_CANVAS_INK_CODES; i++) {
        double f = ink->low + (ink->high - ink->low) * i / 255.0;
        double reach = fmax(fabs(ink->low), fabs(ink->high));
        double t = reach > 0.0 ? f / reach : 0.0;
        ink->palette[i] = ink->colours != WR_CANVAS_SIGNED
                              ? grey_of(i, ink->colours == WR_CANVAS_CONTOURS)
                          : t < 0.0 ? mix(white, blue, -t)
                                    : mix(white, orange, t);
    }
    make_marks(ink, marks);
}

/* A level surface is middle grey for any light, so that there is room for darker and lighter slopes. */
static void make_tones(WrCanvasInk *ink)
{
    double level = fmax((double)ink->light[2], 0.05), gamma = log(0.55) / log(level);
    if (!(level < 0.95)) gamma = 4.0;
    for (int i = 0; i <= WR_CANVAS_INK_TONES; i++) {
        uint32_t g = (uint32_t)lrint(255.0 * pow(i / (double)WR_CANVAS_INK_TONES, gamma));
        ink->tones[i] = 0xff000000u | g << 16 | g << 8 | g;
    }
}

double wr_canvas_ink_step(double low, double high)
{
    double range = high - low;
    if (!(range > 0.0) || !isfinite(range)) return 1.0;
    double most = range / LINES, power = pow(10.0, floor(log10(most)));
    double part = most / power;
    /* The borders are the arithmetic means of neighbouring round numbers: 1, 2, 5, 10. */
    return power * (part < 1.5 ? 1.0 : part < 3.5 ? 2.0 : part < 7.5 ? 5.0 : 10.0);
}

void wr_canvas_ink_make(WrCanvasInk *ink, const WrCanvasDisplay *look, double low, double high)
{
    double x = look->light_x, y = look->light_y, flat = x * x + y * y;
    ink->colours = look->colours;
    ink->low = low;
    ink->high = high;
    ink->step = wr_canvas_ink_step(low, high);
    ink->light[0] = (float)x;
    ink->light[1] = (float)y;
    ink->light[2] = (float)sqrt(fmax(0.0, 1.0 - flat));
    make_palette(ink, look->marks);
    make_tones(ink);
}

/* scaled: 0 black, 255 white. */
static int code_of(float scaled)
{
    if (scaled < -BEYOND) return WR_CANVAS_INK_CODES;
    if (scaled > WR_CANVAS_INK_CODES - 1 + BEYOND) return WR_CANVAS_INK_CODES + 1;
    float code = scaled + 0.5f;
    code = code > 0.0f ? code : 0.0f; /* also maps NaN to 0 */
    return (int)(code < WR_CANVAS_INK_CODES - 1 ? code : WR_CANVAS_INK_CODES - 1);
}

uint32_t wr_canvas_ink_colour(const WrCanvasInk *ink, double height)
{
    return ink->palette[code_of(
        (float)((height - ink->low) * (WR_CANVAS_INK_CODES - 1) / (ink->high - ink->low)))];
}

/* Colour of the contour between two steps; 0: the steps are equal, or one is NaN. Zero has priority, then every
   fifth. */
static uint32_t line_between(double a, double b)
{
    double low = fmin(a, b), high = fmax(a, b);
    if (low == high) return 0;
    if (low < 0.0 && high >= 0.0) return 0xffc05a10u;
    return floor(low / MAJOR) != floor(high / MAJOR) ? 0xff101010u : 0xff505860u;
}

static uint32_t stronger(uint32_t a, uint32_t b)
{
    return a == 0 ? b : b == 0 ? a : (a & 0xffu) < (b & 0xffu) ? a : b;
}

void wr_canvas_ink_heights(const WrCanvasInk *ink, const float *heights, float left,
                           const float *above, int count, uint32_t *out)
{
    float low = (float)ink->low;
    float scale = (float)((WR_CANVAS_INK_CODES - 1) / (ink->high - ink->low));
    for (int i = 0; i < count; i++) out[i] = ink->palette[code_of((heights[i] - low) * scale)];
    if (ink->colours != WR_CANVAS_CONTOURS) return;
    double before = floor((double)left / ink->step);
    for (int i = 0; i < count; i++) {
        double here = floor((double)heights[i] / ink->step);
        double over = above ? floor((double)above[i] / ink->step) : here;
        uint32_t line = stronger(line_between(before, here), line_between(over, here));
        if (line) out[i] = line;
        before = here;
    }
}

static uint32_t normal_colour(float x, float y, float z)
{
    uint32_t r = (uint32_t)lrintf(127.5f + 127.5f * x), g = (uint32_t)lrintf(127.5f + 127.5f * y);
    return 0xff000000u | r << 16 | g << 8 | (uint32_t)lrintf(127.5f + 127.5f * z);
}

void wr_canvas_ink_slopes(const WrCanvasInk *ink, const float *p, const float *q, int count,
                          uint32_t *out)
{
    const float *l = ink->light;
    for (int i = 0; i < count; i++) {
        float a = isfinite(p[i]) ? p[i] : 0.0f, b = isfinite(q[i]) ? q[i] : 0.0f;
        float k = 1.0f / sqrtf(1.0f + a * a + b * b);
        if (ink->colours == WR_CANVAS_NORMALS) {
            out[i] = normal_colour(-a * k, -b * k, k);
        } else {
            float lit = (l[2] - a * l[0] - b * l[1]) * k;
            lit = lit < 0.0f ? 0.0f : lit > 1.0f ? 1.0f : lit;
            out[i] = ink->tones[(int)(lit * WR_CANVAS_INK_TONES + 0.5f)];
        }
    }
}

/* ---- range of greys ---- */

#define LEVEL_REACH 0.5 /* least range on each side of zero for a level table */
#define ROOM 0.125      /* margin, as a fraction of the range */
#define NEAR 0.5        /* an end passed by less than this fraction gets the margin */
#define USED_MIN 0.125  /* least used fraction of the range */
#define SLIGHT                                                                                     \
    0.25 /* if dents are much shallower than bumps are high, they must not take half of the greys */

static void own_range(double range[2], double low, double high)
{
    const bool level = !(high > low), signs = level || low < fmin(0.0, -SLIGHT * high);
    double reach = fmax(fabs(low), fabs(high));
    if (level) reach = fmax(LEVEL_REACH, 2.0 * reach);
    range[0] = signs ? -reach : low;
    range[1] = signs ? reach : high;
}

static bool is_empty(const double range[2])
{
    return !(range[1] - range[0] > 0.0);
}

void wr_range_follow(double range[2], double low, double high)
{
    const double span = range[1] - range[0], room = ROOM * span;
    const bool spare = high > low && high - low < USED_MIN * span;
    if (is_empty(range) || spare) {
        const bool signs = spare && range[0] == -range[1]; /* zero stays mid-grey */
        own_range(range, signs ? -fmax(fabs(low), fabs(high)) : low, high);
        return;
    }
    if (low < range[0]) range[0] = range[0] - low < NEAR * span ? low - room : low;
    if (high > range[1]) range[1] = high - range[1] < NEAR * span ? high + room : high;
}

void wr_range_widen(double range[2], double low, double high)
{
    if (is_empty(range)) own_range(range, low, high);
    range[0] = fmin(range[0], low);
    range[1] = fmax(range[1], high);
}

/* With `decimals`, but without trailing zeros and without "-0". */
static void print_end(double value, int decimals, char text[WR_RANGE_TEXT])
{
    const double unit = pow(10.0, decimals);
    if (!(fabs(value) < 1e6)) snprintf(text, WR_RANGE_TEXT, "%.3g", value);
    else snprintf(text, WR_RANGE_TEXT, "%.*f", decimals, rint(value * unit) / unit + 0.0);
    if (!strchr(text, '.')) return;
    size_t length = strlen(text);
    while (text[length - 1] == '0') length--;
    if (text[length - 1] == '.') length--;
    text[length] = '\0';
}

void wr_range_print(double low, double high, char black[WR_RANGE_TEXT], char white[WR_RANGE_TEXT])
{
    const double span = high - low, leading = span > 0.0 ? floor(log10(span)) : 0.0;
    const int decimals = (int)fmax(0.0, fmin(12.0, 2.0 - leading));
    print_end(low, decimals, black);
    print_end(high, decimals, white);
}

/* ---- thumbnails ---- */

#define NOTHING 0x48 /* grey of uncovered areas */

static float texel(const WrField *field, double u, double v)
{
    int w = wr_field_width(field), h = wr_field_height(field);
    int i = (int)(u * w), j = (int)(v * h);
    return wr_field_get(field, i < w ? i : w - 1, j < h ? j : h - 1);
}

/* Mean of four texels for pixel (x, y). */
static float pixel(const WrField *field, int x, int y, int side)
{
    double sum = 0.0;
    for (int k = 0; k < 4; k++)
        sum += (double)texel(field, (x + 0.25 + 0.5 * (k & 1)) / side,
                             (y + 0.25 + 0.5 * (k >> 1)) / side);
    return (float)(sum / 4.0);
}

void wr_thumb_draw(const WrField *field, const WrField *cover, bool unit, int side, uint32_t *argb)
{
    float heights[WR_THUMB_MAX * WR_THUMB_MAX], low = INFINITY, high = -INFINITY;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            float f = pixel(field, x, y, side);
            heights[y * side + x] = f;
            low = f < low ? f : low;
            high = f > high ? f : high;
        }
    if (unit || !(high > low)) {
        low = 0.0f;
        high = 1.0f;
    } else if (cover) {
        high = -low > high ? -low : high;
        low = -high;
    }
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double grey = ((double)heights[y * side + x] - (double)low) /
                          ((double)high - (double)low) * 255.0;
            grey = grey > 0.0 ? grey < 255.0 ? grey : 255.0 : 0.0;
            double c = cover ? (double)pixel(cover, x, y, side) : 1.0;
            c = c > 0.0 ? c < 1.0 ? c : 1.0 : 0.0;
            uint32_t g = (uint32_t)lrint(NOTHING + c * (grey - NOTHING));
            argb[y * side + x] = 0xff000000u | g << 16 | g << 8 | g;
        }
}
