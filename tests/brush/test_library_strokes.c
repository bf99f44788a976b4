/* Every preset of the library paints: all of MyPaint's package, and our own. */
#include "test.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "brush/library.h"
#include "field/field.h"

#define SIDE 160

/* Hills and hollows to drag, smooth, fill and erase. */
static WrField *hills(void)
{
    WrField *field = wr_field_new(SIDE, SIDE, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            wr_field_set(field, i, j,
                         (float)((i * 7 + j * 3) % 40 < 20 ? -0.25 : 0.5) +
                             (float)(i % 16) / 64.0f);
    return field;
}

/* A curve with pressure rising and falling, in half a second. */
static WrHash paint(const WrPreset *preset, const WrField *ground, WrPool *pool, WrField **painted)
{
    WrBrush brush = wr_preset_brush(preset);
    brush.seed = 11;
    if (brush.radius > 24.0) brush.radius = 24.0;
    WrBrushGround on = { .field = wr_field_share(ground), .pool = pool };
    WrStroke *stroke = wr_stroke_new_on(&on, &brush);
    for (int i = 0; i <= 24; i++) {
        double t = i / 24.0;
        wr_stroke_add(stroke, (WrSample){ .u = 0.2 + 0.6 * t,
                                          .v = 0.5 + 0.6 * t * (1 - t),
                                          .pressure = 0.3 + 2.4 * t * (1 - t),
                                          .tilt_x = 0.2,
                                          .tilt_y = 0.1,
                                          .seconds = 0.5 * t });
    }
    wr_stroke_finish(stroke);
    WrHash hash = wr_field_hash(on.field);
    if (painted) {
        *painted = on.field;
    } else {
        wr_field_free(on.field);
    }
    return hash;
}

static void check_preset(const WrPresetEntry *entry, const WrField *ground, WrPool *const pools[2])
{
    WrError err;
    WrPreset *preset = wr_preset_read(entry->path, entry->id, &err);
    if (!preset) fail_msg("%s: %s", entry->id, err.text);
    WrField *painted = NULL;
    WrHash first = paint(preset, ground, NULL, &painted);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            if (!isfinite(wr_field_get(painted, i, j)))
                fail_msg("%s: not finite at %d,%d", entry->id, i, j);
    wr_field_free(painted);
    bool changed = !wr_hash_equal(first, wr_field_hash(ground));
    if (!changed && !wr_preset_is_colour_only(preset)) fail_msg("%s paints nothing", entry->id);
    for (int k = 0; k < 2; k++)
        if (!wr_hash_equal(first, paint(preset, ground, pools[k], NULL)))
            fail_msg("%s: other heights the next time, with %d threads", entry->id, k + 1);
    wr_preset_free(preset);
}

static int check_collection(const char *collection)
{
    WrLibrary *library = wr_library_new();
    WrField *ground = hills();
    WrPool *pools[2] = { wr_pool_new(1), wr_pool_new(2) };
    int count = 0;
    for (int i = 0; i < wr_library_count(library); i++) {
        const WrPresetEntry *entry = wr_library_entry(library, i);
        if (strcmp(entry->collection, collection) != 0) continue;
        check_preset(entry, ground, pools);
        count++;
    }
    for (int k = 0; k < 2; k++) wr_pool_free(pools[k]);
    wr_field_free(ground);
    wr_library_free(library);
    return count;
}

static void all_196_presets_of_mypaint_2_paint_and_repeat(void **state)
{
    (void)state;
    assert_int_equal(check_collection("mypaint2"), 196);
}

static void all_177_presets_of_mypaint_1_paint_and_repeat(void **state)
{
    (void)state;
    assert_int_equal(check_collection("mypaint1"), 177);
}

static void our_own_presets_paint_and_repeat(void **state)
{
    (void)state;
    assert_true(check_collection("wrinkle") >= 26);
}

/* Our own presets parse without skipped or clamped values, each has a description, and no two are equal. */
static void our_own_presets_are_clean_and_tell_what_they_are_for(void **state)
{
    (void)state;
    static const char *const groups[] = { "Relief basics", "Tools", "Texture", "Stamps" };
    int seen[4] = { 0 };
    WrLibrary *library = wr_library_new();
    for (int i = 0; i < wr_library_count(library); i++) {
        const WrPresetEntry *entry = wr_library_entry(library, i);
        if (strcmp(entry->collection, "wrinkle") != 0) continue;
        WrError err;
        WrPreset *preset = wr_preset_read(entry->path, entry->id, &err);
        if (!preset) fail_msg("%s: %s", entry->id, err.text);
        if (wr_preset_skipped(preset) > 0) fail_msg("%s: values out of range", entry->id);
        const char *text = wr_preset_description(preset);
        if (strlen(text) < 20 || text[strlen(text) - 1] != '.')
            fail_msg("%s: '%s' does not describe it", entry->id, text);
        assert_string_equal(wr_preset_group(preset), entry->group); /* as in order.conf */
        int group = 0;
        while (group < 4 && strcmp(groups[group], entry->group) != 0) group++;
        if (group == 4) fail_msg("%s: group %s", entry->id, entry->group);
        seen[group]++;
        assert_false(wr_preset_is_colour_only(preset));
        wr_preset_free(preset);
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k] >= 5);
    wr_library_free(library);
}

int main(void)
{
    setenv("WRINKLE_DATA", WR_SOURCE_DIR, 1);
    setenv("XDG_DATA_HOME", "/no/such/folder", 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_196_presets_of_mypaint_2_paint_and_repeat),
        cmocka_unit_test(all_177_presets_of_mypaint_1_paint_and_repeat),
        cmocka_unit_test(our_own_presets_paint_and_repeat),
        cmocka_unit_test(our_own_presets_are_clean_and_tell_what_they_are_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
