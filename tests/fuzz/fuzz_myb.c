/* Fuzz target: brush presets from arbitrary bytes. The first byte selects:
     even  the rest is the file
     odd   the next two select one of MyPaint's presets; the rest are edits of it, four bytes each: position
           (2), operation, and byte
   A parsed preset is printed; the text must parse again and print the same. It also draws a short stroke through the
   engine, whose dabs must be finite. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/mypaint_engine.h"
#include "brush/library.h"

#include <math.h>
#include <string.h>

#define FAR_TOO_MANY 3000000 /* dabs of one stroke */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition) abort();
}

/* Loaded once, at the first input. */
static struct {
    WrLibrary *library;
    int count;
} seeds;

static char *seed_text(unsigned index, size_t *length)
{
    if (!seeds.library) {
        setenv("XDG_DATA_HOME", "/no/such/folder", 1);
        seeds.library = wr_library_new();
        seeds.count = wr_library_count(seeds.library);
        require(seeds.count > 0);
    }
    char *text;
    const WrPresetEntry *entry = wr_library_entry(seeds.library, (int)index % seeds.count);
    require(wr_file_read(entry->path, WR_PRESET_BYTES, &text, length, NULL));
    return text;
}

static void edit(WrText *text, const uint8_t *how)
{
    static const char *const words[] = { "0",  "-1e30", "1e30", "[0,0]", "[]",    "{}",     "null",
                                         "\"", ",",     "64",   "0.001", "1e-38", "[0,0],", "-0" };
    size_t at = text->length ? (how[0] | (size_t)how[1] << 8) % text->length : 0;
    WrText made = { 0 };
    size_t skip = how[2] % 4 == 1 ? 1 : how[2] % 4 == 2 ? (size_t)how[3] : 0;
    skip = skip < text->length - at ? skip : text->length - at;
    wr_text_add_n(&made, wr_text_get(text), at);
    if (how[2] % 4 == 0) wr_text_add_n(&made, (const char *)how + 3, 1);
    if (how[2] % 4 >= 2) wr_text_add(&made, words[how[3] % (sizeof words / sizeof *words)]);
    wr_text_add_n(&made, wr_text_get(text) + at + skip, text->length - at - skip);
    wr_text_fini(text);
    *text = made;
}

static void count_dab(void *ctx, const WrDab *dab)
{
    int *count = ctx;
    require(isfinite(dab->x) && isfinite(dab->y) && isfinite(dab->angle_rad));
    require(isfinite(dab->radius) && dab->radius > 0.0 && isfinite(dab->dx) && isfinite(dab->dy));
    require(dab->alpha > 0.0 && dab->alpha <= 1.0 && dab->hardness > 0.0 && dab->hardness <= 1.0);
    require(dab->aspect >= 1.0 && isfinite(dab->aspect) && isfinite(dab->dragged));
    require(dab->drag >= 0.0 && dab->drag <= 1.0 && ++*count < FAR_TOO_MANY);
}

static double height_there(void *ctx, double x, double y, double radius)
{
    (void)ctx;
    require(isfinite(x) && isfinite(y) && radius > 0.0);
    return x - y;
}

static void draw(const WrPreset *preset)
{
    static const WrEnginePoint path[] = { { 10, 10, 0.1, 0, 0, 0 },
                                          { 50, 20, 1, 0.5, -0.5, 0.1 },
                                          { 50, 20, 1, 0.5, -0.5, 0.13 },
                                          { 400, 300, 0.4, -1, 1, 0.132 } };
    int count = 0;
    WrBrush brush = wr_preset_brush(preset);
    WrDabSink sink = { &count, count_dab, height_there };
    WrEngine *engine = wr_engine_new(&brush, &sink);
    for (size_t i = 0; i < sizeof path / sizeof *path; i++) {
        wr_engine_push(engine, &path[i]);
        while (wr_engine_step(engine)) continue;
    }
    wr_engine_pen_up(engine);
    while (wr_engine_step(engine)) continue;
    wr_engine_free(engine);
}

static WrPreset *parse(const char *text, size_t length)
{
    WrError err = { "" };
    WrPreset *preset = wr_preset_parse(text, length, "fuzz", NULL, &err);
    require(preset || strncmp(err.text, "fuzz", 4) == 0);
    return preset;
}

static void check(const char *bytes, size_t length)
{
    WrPreset *preset = parse(bytes, length);
    if (!preset) return;
    WrText first = { 0 }, second = { 0 };
    WrBrush brush = wr_preset_brush(preset);
    wr_preset_print(preset, &brush, &first);
    WrPreset *again = parse(first.data, first.length);
    require(again != NULL);
    brush = wr_preset_brush(again);
    wr_preset_print(again, &brush, &second);
    require(strcmp(first.data, second.data) == 0);
    draw(preset);
    wr_text_fini(&first);
    wr_text_fini(&second);
    wr_preset_free(again);
    wr_preset_free(preset);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3) return 0;
    if (data[0] % 2 == 0) {
        check((const char *)data + 1, size - 1);
        return 0;
    }
    size_t length;
    char *seed = seed_text(data[1] | (unsigned)data[2] << 8, &length);
    WrText text = { 0 };
    wr_text_add_n(&text, seed, length);
    wr_free(seed);
    for (size_t i = 3; i + 4 <= size && i < 3 + 4 * 64; i += 4) edit(&text, data + i);
    check(wr_text_get(&text), text.length);
    wr_text_fini(&text);
    return 0;
}
