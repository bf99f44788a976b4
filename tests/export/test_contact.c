/* Contact sheets: each tile is the map of its name, texel by texel or by means, at its position; for a set they are
   written with its maps or not at all. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/text.h"
#include "document/document.h"
#include "export/export.h"
#include "export/map_sets.h"
#include "field/field.h"
#include "image/image.h"
#include "system/path.h"

#define GAP 12
#define NAME_H 22

static WrDocument *rough_document(int w, int h)
{
    uint32_t seed = 5;
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int k = 0; k < w * h; k++) {
        seed = seed * 1664525u + 1013904223u;
        wr_field_set(field, k % w, k / w, (float)(seed / 4294967296.0));
    }
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    return document;
}

#define WORDS(...) ((const char *const[]){ __VA_ARGS__, NULL })

static WrImage *exported(const WrDocument *document, const char *kind, const char *const *words,
                         const char *path)
{
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    for (; words[0]; words += 2)
        if (!wr_export_option(wr_export_find(kind), &options, words[0], words[1], &err))
            fail_msg("%s", err.text);
    if (!wr_export(wr_export_find(kind), document, &options, NULL, path, NULL, &err))
        fail_msg("%s", err.text);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static int code_at(const WrImage *image, int x, int y, int c)
{
    const size_t at = (size_t)y * (size_t)image->width + (size_t)x;
    return (int)lrint(255 * (double)image->data[at * (size_t)image->channels + (size_t)c]);
}

/* Tile k of three, in a grid of two columns: the map's texels each `every` to a pixel and side. */
static void assert_tile(const WrImage *sheet, int k, const WrImage *map, int tile, int every)
{
    const int w = map->width / every, h = map->height / every;
    const int left = GAP + k % 2 * (tile + GAP) + (tile - w) / 2;
    const int top = GAP + k / 2 * (tile + NAME_H + GAP) + (tile - h) / 2;
    for (int n = 0; n < w * h * 3; n++) {
        const int x = n / 3 % w, y = n / 3 / w, c = n % 3, own = map->channels == 1 ? 0 : c;
        int sum = 0;
        for (int t = 0; t < every * every; t++)
            sum += code_at(map, x * every + t % every, y * every + t / every, own);
        const int want = (int)floor((double)sum / (every * every) + 0.5);
        if (code_at(sheet, left + x, top + y, c) != want)
            fail_msg("tile %d at %d,%d,%d: %d, not %d", k, x, y, c,
                     code_at(sheet, left + x, top + y, c), want);
    }
    assert_int_equal(code_at(sheet, left - 1, top + h / 2, 0), 38);
    assert_int_equal(code_at(sheet, left + w / 2, top - 1, 0), 38);
}

static const char *const kinds[] = { "height", "normal-y", "occlusion" };

static void each_tile_is_the_map_of_its_name(void **state)
{
    (void)state;
    const struct {
        int w, h, tile, every;
        const char *text;
    } cases[] = { { 48, 64, 64, 1, "64" }, { 96, 63, 32, 3, "32" } };
    for (int n = 0; n < 2; n++) {
        WrDocument *document = rough_document(cases[n].w, cases[n].h);
        WrImage *sheet =
            exported(document, "contact",
                     WORDS("maps", "height;normal-y;occlusion", "tile", cases[n].text), "c.png");
        assert_int_equal(sheet->channels, 3);
        assert_int_equal(sheet->width, GAP + 2 * (cases[n].tile + GAP));
        assert_int_equal(sheet->height, GAP + 2 * (cases[n].tile + NAME_H + GAP));
        for (int k = 0; k < 3; k++) {
            WrImage *map = exported(document, kinds[k], WORDS("depth", "8"), "m.png");
            assert_tile(sheet, k, map, cases[n].tile, cases[n].every);
            wr_image_free(map);
        }
        wr_image_free(sheet);
        wr_document_free(document);
    }
}

/* By default: all maps of the cell, and none that needs a mesh. */
static void all_maps_of_the_cell_are_shown(void **state)
{
    (void)state;
    int count = 0, columns = 1;
    WrDocument *document = rough_document(9, 7);
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        count += !wr_export_kinds[i].write && !wr_export_kinds[i].on_surface;
    while (columns * columns < count) columns++;
    WrImage *sheet = exported(document, "contact", WORDS("tile", "40"), "c.png");
    assert_int_equal(sheet->width, GAP + columns * (40 + GAP));
    wr_image_free(sheet);
    wr_document_free(document);
}

static void a_set_has_one_where_asked_for(void **state)
{
    (void)state;
    WrDocument *document = rough_document(33, 21);
    WrError err = { "" };
    WrText told = { 0 };
    WrMapSet *set = wr_map_set_find("unity", &err);
    const char *const words[] = { "contact=all.png" };
    static const struct {
        const char *word, *says;
    } bad[] = { { "contact=../all.png", "without a folder" },
                { "contact=", "without a folder" },
                { "contact=all.xyz", "extension 'xyz'" },
                { "contact=clay_Height.png", "is the name of one of the maps" } };
    WrMapSetRequest order = { set, ".", "clay", words, 1, NULL };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const WrMapSetRequest wrong = { set, ".", "clay", &bad[i].word, 1, NULL };
        assert_false(wr_export_map_set(&wrong, document, NULL, &told, &err));
        if (!strstr(err.text, bad[i].says)) fail_msg("%s", err.text);
        assert_false(wr_path_is_there("clay_Height.png")); /* all or none */
        assert_true(told.length == 0);
    }
    if (!wr_export_map_set(&order, document, NULL, &told, &err)) fail_msg("%s", err.text);
    assert_non_null(strstr(wr_text_get(&told), "all.png: contact sheet of 3 maps"));
    WrImage *sheet = wr_image_read("all.png", &err);
    if (!sheet) fail_msg("%s", err.text);
    assert_int_equal(sheet->width, GAP + 2 * (256 + GAP));
    wr_image_free(sheet);
    wr_map_set_free(set);
    wr_text_fini(&told);
    wr_document_free(document);
}

static void what_cannot_be_shown_is_refused(void **state)
{
    (void)state;
    WrExportOptions options = wr_export_default();
    const WrExportKind *kind = wr_export_find("contact");
    static const char *const bad[][2] = { { "maps", "height;stl" }, { "maps", "contact" },
                                          { "maps", "" },           { "maps", "height;;nothing" },
                                          { "tile", "31" },         { "tile", "40.5" },
                                          { "tile", "1025" } };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrError err = { "" };
        assert_false(wr_export_option(kind, &options, bad[i][0], bad[i][1], &err));
        assert_non_null(strstr(err.text, bad[i][0]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_tile_is_the_map_of_its_name),
        cmocka_unit_test(all_maps_of_the_cell_are_shown),
        cmocka_unit_test(a_set_has_one_where_asked_for),
        cmocka_unit_test(what_cannot_be_shown_is_refused),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
