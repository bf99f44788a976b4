/* Output of the illusion measurement: as sentences, as a table and as JSON. */
#include "accuracy/illusion.h"
#include "base/text.h"

#include <math.h>

#define SEEN 0.5       /* pixels: smaller differences are invisible (E50) */
#define CODE 0.004     /* linear intensity: about one code of 255 at middle grey */
#define FULL_SCALE 0.1 /* linear intensity of full colour in the map, as in error pictures */

void wr_illusion_colour(const WrIllusion *illusion, size_t pixel, uint8_t rgb[3])
{
    for (int c = 0; c < 3; c++) {
        const double value = (double)illusion->map[3 * pixel + (size_t)c] / (c ? FULL_SCALE : 1);
        rgb[c] = (uint8_t)lrint(255 * fmin(fmax(value, 0), 1));
    }
}

void wr_illusion_height(const WrIllusion *illusion, WrText *text)
{
    const double moved = fmax(illusion->way, illusion->hausdorff); /* fmax ignores NAN */
    const bool shadows = illusion->shadow >= CODE;
    if (!(moved >= SEEN))
        wr_text_add(text, shadows ? "Nobody sees the difference here, but for shadows."
                                  : "Nobody sees the difference here.");
    else
        wr_text_addf(text, "Below height %.3g nobody sees %s.",
                     fabs(illusion->bump_height) * SEEN / moved,
                     shadows ? "it here, but for shadows" : "the difference here");
}

static void add_outline(const WrIllusion *it, WrText *text)
{
    const double moved = it->hausdorff;
    if (!(moved >= 0)) {
        wr_text_add(text, "No outline is in the picture. ");
    } else if (moved < SEEN) {
        wr_text_addf(text, "The outline is %.2g pixels off at most, which nobody sees. ", moved);
    } else {
        wr_text_addf(text, "The outline is up to %.3g pixels off. ", moved);
        if (it->rise > 0)
            wr_text_addf(text, "Below height %.3g no point moves by half a pixel. ",
                         fabs(it->bump_height) * SEEN / it->rise);
    }
}

static void add_inside(const WrIllusion *it, WrText *text)
{
    if (it->common == 0) return;
    if (it->way < SEEN)
        wr_text_addf(text, "Places are %.2g pixels from where bump shows them at most. ", it->way);
    else
        wr_text_addf(
            text,
            "Places are %.2g pixels from where bump shows them, %.2g at most: below height "
            "%.3g not half a pixel. ",
            it->way_mean, it->way, fabs(it->bump_height) * SEEN / it->way);
    if (it->shadow < CODE) wr_text_add(text, "Shadows of the relief make no difference.");
    else if (it->shadow > it->shading)
        wr_text_add(text, "Most of it is shadow: material shadow=on brings that to bump mapping.");
    else wr_text_add(text, "Shadow is the smaller part: what differs is where things are seen.");
}

void wr_illusion_advice(const WrIllusion *illusion, WrText *text)
{
    wr_illusion_height(illusion, text);
    wr_text_add(text, " ");
    add_outline(illusion, text);
    add_inside(illusion, text);
}

typedef struct Number {
    const char *name, *words;
    double value;
} Number;

#define NUMBERS 11
static void numbers_of(const WrIllusion *it, Number out[NUMBERS])
{
    const Number numbers[NUMBERS] = {
        { "outline", "outline, pixels of area", it->outline },
        { "outline_mean", "the same over its length", it->outline_mean },
        { "hausdorff", "farthest from the other", it->hausdorff },
        { "perimeter", "length of bump's outline", it->perimeter },
        { "shading", "shading, rms at the same pixel", it->shading },
        { "shading_at", "rms at the same u and v", it->shading_at },
        { "shadow", "shadow, rms", it->shadow },
        { "all", "shading and shadow, rms", it->all },
        { "moved_mean", "places moved, mean pixels", it->way_mean },
        { "moved_most", "places moved, at most", it->way },
        { "rise", "what F could move, pixels", it->rise },
    };
    for (int i = 0; i < NUMBERS; i++) out[i] = numbers[i];
}

void wr_illusion_text(const WrIllusion *illusion, const char *name, WrText *text)
{
    Number numbers[NUMBERS];
    numbers_of(illusion, numbers);
    wr_text_addf(text, "%s%s%d x %d pixels: bump mapping beside displacement\n\n", name,
                 name[0] ? ", " : "", illusion->width, illusion->height);
    for (int i = 0; i < NUMBERS; i++)
        wr_text_addf(text, "%-32s %10.4g\n", numbers[i].words, numbers[i].value);
    wr_text_add(text, "\n");
    wr_illusion_advice(illusion, text);
    wr_text_add(text, "\n");
}

void wr_illusion_json(const WrIllusion *illusion, const char *name, WrText *text)
{
    Number numbers[NUMBERS];
    WrText advice = { 0 };
    numbers_of(illusion, numbers);
    wr_illusion_advice(illusion, &advice);
    wr_text_add(text, "{\"document\":");
    wr_text_add_json_string(text, name);
    wr_text_addf(text, ",\"width\":%d,\"height\":%d", illusion->width, illusion->height);
    for (int i = 0; i < NUMBERS; i++) {
        wr_text_addf(text, ",\"%s\":", numbers[i].name);
        wr_text_add_json_number(text, numbers[i].value);
    }
    wr_text_add(text, ",\"advice\":");
    wr_text_add_json_string(text, wr_text_get(&advice));
    wr_text_add(text, "}\n");
    wr_text_fini(&advice);
}
