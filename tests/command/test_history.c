/* History: bit-identical undo and redo of everything; the memory budget; the history as a script. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "command/session.h"
#include "command/command_table.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <sys/stat.h>
#include <unistd.h>

/* A tenth of the counts, unless the full ones are requested. */
static int count_of(int full)
{
    const char *all = getenv("WR_FULL");
    return all && *all && strcmp(all, "0") != 0 ? full : full / 10;
}

static bool has_hash(const WrSession *session, WrHash hash)
{
    return wr_hash_equal(hash, wr_session_hash(session));
}

/* ---- going back and forth ---- */

static void hc81_a_thousand_strokes_are_undone_and_redone_bit_for_bit(void **state)
{
    (void)state;
    enum { STROKES = 1000, KEPT = 40 };
    TestRandom random = { 81 };
    WrHash hashes[KEPT + 1];
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 300x200");
    must_run(s, "grid");
    must_run(s, "layer add blend=max");
    int first = wr_session_history_position(s);
    hashes[0] = wr_session_hash(s);
    for (int i = 1; i <= STROKES; i++) {
        char line[200];
        snprintf(line, sizeof line,
                 "stroke points=%.4f,%.4f;%.4f,%.4f radius=%.3f strength=%.4f mode=%s",
                 test_random(&random), test_random(&random), test_random(&random),
                 test_random(&random), 20 * test_random(&random), test_random(&random) - 0.3,
                 i % 3 ? "raise" : "lower");
        must_run(s, line);
        if (i % (STROKES / KEPT) == 0) hashes[i / (STROKES / KEPT)] = wr_session_hash(s);
    }
    for (int round = 0; round < 2; round++) {
        for (int i = STROKES - 1; i >= 0; i--) {
            must_run(s, "undo");
            if (i % (STROKES / KEPT) == 0) assert_true(has_hash(s, hashes[i / (STROKES / KEPT)]));
        }
        for (int i = 1; i <= STROKES; i++) {
            must_run(s, "redo");
            if (i % (STROKES / KEPT) == 0) assert_true(has_hash(s, hashes[i / (STROKES / KEPT)]));
        }
    }
    WrError err;
    assert_true(wr_session_history_go(s, first, &err) && has_hash(s, hashes[0]));
    wr_session_free(s);
}

static void undo_redo_and_their_limits(void **state)
{
    (void)state;
    WrError err = { "" };
    WrSession *s = wr_session_new(NULL);
    must_fail(s, "undo", "nothing to undo");
    must_fail(s, "redo", "nothing to redo");
    assert_int_equal((int)wr_session_revision(s), 0);
    must_run(s, "fill 1");
    must_run(s, "surface torus");
    must_run(s, "fill 2");
    must_fail(s, "undo 4", "4 steps: 3 can be undone");
    must_run(s, "undo 2");
    assert_int_equal(wr_session_history_position(s), 1);
    assert_int_equal(wr_session_history_count(s), 3);
    assert_string_equal(wr_session_last_command(s), "fill 1");
    assert_string_equal(wr_session_history_line(s, 2), "fill 2");
    assert_true(doc(s)->scene->shape.kind == WR_SURFACE_plane);
    must_fail(s, "redo 3", "3 steps: 2 can be redone");
    must_run(s, "redo");
    assert_true(doc(s)->scene->shape.kind == WR_SURFACE_torus);
    assert_false(wr_session_history_go(s, 4, &err));
    assert_false(wr_session_history_go(s, -1, &err));
    must_run(s, "fill 3"); /* the branch of fill 2 is dropped */
    assert_int_equal(wr_session_history_count(s), 3);
    assert_string_equal(wr_session_history_line(s, 2), "fill 3");
    must_fail(s, "redo", "nothing to redo");
    must_fail(s, "dab 0,0 radius=-1", "radius=-1"); /* a failure is no step */
    assert_int_equal(wr_session_history_count(s), 3);
    assert_string_equal(wr_session_history_line(s, 3), "");
    assert_string_equal(wr_session_history_line(s, -1), "");
    wr_session_free(s);
}

static void undoing_back_to_the_saved_state_makes_it_saved_again(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 8x8");
    must_run(s, "fill 1");
    if (!wr_session_save(s, "s.exr", &err)) fail_msg("%s", err.text);
    must_run(s, "fill 2");
    assert_true(wr_session_revision(s) != wr_session_saved_revision(s));
    must_run(s, "undo");
    assert_true(wr_session_revision(s) == wr_session_saved_revision(s));
    must_run(s, "undo");
    assert_true(wr_session_revision(s) != wr_session_saved_revision(s));
    must_run(s, "fill 1"); /* looks the same, but is another state */
    assert_true(wr_session_revision(s) != wr_session_saved_revision(s));
    wr_session_free(s);
}

static void going_back_does_not_reach_snapshots_that_others_hold(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "layer add blend=max");
    must_run(s, "dab 0.5,0.5 strength=3");
    WrDocument *shared = wr_document_share(doc(s));
    float before = wr_field_get(wr_document_field(shared), 256, 256);
    must_run(s, "undo 2");
    must_run(s, "fill 9");
    assert_true(wr_field_get(wr_document_field(shared), 256, 256) == before && before == 3);
    assert_true(wr_field_get(wr_document_field(doc(s)), 256, 256) == 9);
    wr_document_free(shared);
    wr_session_free(s);
}

/* ---- memory ---- */

#define TILE (64 * 64 * sizeof(float))

static void a_step_costs_the_tiles_that_it_touches(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 4096x4096");
    must_run(s, "grid cells=64x64 width=4");    /* fills every tile: 64 MB */
    must_run(s, "dab 0.5078,0.5078 radius=10"); /* in the middle of a tile */
    must_run(s, "surface torus");
    must_run(s, "bump height=0.31");
    size_t dab = wr_session_history_step_bytes(s, 2), scene = wr_session_history_step_bytes(s, 3);
    assert_true(wr_session_history_step_bytes(s, 1) >= 4096 * TILE);
    assert_true(dab >= TILE && dab < 2 * TILE);
    assert_true(scene < 2000 && wr_session_history_step_bytes(s, 4) == scene);
    assert_true(wr_session_history_bytes(s) < 4200 * TILE);
    wr_session_free(s);
}

static void the_oldest_states_go_when_the_budget_is_full(void **state)
{
    (void)state;
    WrError err = { "" };
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 512x512");
    must_run(s, "history budget=1e6");
    assert_int_equal((int)wr_session_history_budget(s), 1000000);
    for (int i = 0; i < 30; i++) must_run(s, "dab 0.5,0.5 radius=32"); /* 4 tiles, 66 kB */
    int oldest = wr_session_history_oldest(s);
    assert_true(oldest >= 31 - 15 && oldest <= 31 - 13);
    assert_true(wr_session_history_bytes(s) <= 1000000);
    assert_int_equal(wr_session_history_count(s), 31); /* their lines stay */
    assert_string_equal(wr_session_history_line(s, 0), "table 512x512");
    assert_false(wr_session_history_go(s, oldest - 1, &err));
    assert_non_null(strstr(err.text, "dropped"));
    must_fail(s, "undo 31", "can be undone");
    assert_true(wr_session_history_go(s, oldest, &err));
    must_fail(s, "undo", "0 can be undone; older states were given up");
    /* undone states count too: the last of them is dropped first, never the present one */
    must_run(s, "history budget=0");
    assert_int_equal(wr_session_history_count(s), oldest);
    must_run(s, "fill 7");
    must_run(s, "fill 8");
    assert_int_equal(wr_session_history_oldest(s), oldest + 1); /* the last step stays */
    /* heights of kept states can be read without going there */
    assert_true(wr_field_get(wr_session_history_heights(s, oldest + 2), 3, 3) == 8);
    assert_true(wr_field_get(wr_session_history_heights(s, oldest + 1), 3, 3) == 7);
    assert_null(wr_session_history_heights(s, oldest));
    assert_null(wr_session_history_heights(s, oldest + 3));
    assert_null(wr_session_history_heights(s, -1));
    must_run(s, "undo");
    assert_true(wr_field_get(wr_document_field(doc(s)), 3, 3) == 7);
    /* for a filter, those of the layer below, which it changes */
    must_run(s, "filter invert");
    assert_true(wr_field_get(wr_session_history_heights(s, wr_session_history_position(s)), 3, 3) ==
                7);
    wr_session_free(s);
}

/* ---- random commands ---- */

static double number_in(double low, double high, TestRandom *random)
{
    double a = low > -0.5 ? low : -0.5, b = high < 3 ? high : 3;
    if (a >= b) return low;
    return floor((a + (b - a) * test_random(random)) * 1e4) / 1e4;
}

/* Sizes and lengths that keep tables small. */
static double whole_in(const WrArgSpec *s, double low, double high, TestRandom *random)
{
    double a = low > 1 ? low : 1, b = s->type == WR_ARG_SIZE ? 150 : s->unit ? 90 : 4;
    if (low < 0) a = -9;
    if (high < b) b = high;
    return a >= b ? a : floor(a + (b - a + 1) * test_random(random));
}

static void add_number(const WrArgSpec *s, int part, TestRandom *random, WrText *line)
{
    double low = s->parts ? s->parts[part].low : s->low;
    double high = s->parts ? s->parts[part].high : s->high;
    bool whole = s->whole || s->type == WR_ARG_SIZE || (s->parts && s->parts[part].whole);
    bool length = s->unit && strcmp(s->unit, "texels") == 0;
    double x = whole ? whole_in(s, low, high, random) : number_in(low, high, random);
    if (!whole && length) x = fmin(high, floor(150 * test_random(random)) / 8 + 0.125);
    wr_text_add_number(line, x);
}

static void add_value(const WrArgSpec *s, TestRandom *random, WrText *line)
{
    int words = 0, rows = 1;
    if (s->type == WR_ARG_CHOICE) {
        while (wr_arg_word(s, words)) words++;
        wr_text_add(line, wr_arg_word(s, (int)(test_random(random) * words)));
        return;
    }
    if (s->type == WR_ARG_NAME || s->type == WR_ARG_LAYER) {
        wr_text_addf(line, "%d", 1 + (int)(test_random(random) * 3));
        return;
    }
    if (s->type == WR_ARG_LIST)
        rows = s->rows_low == s->rows_high ? s->rows_low
                                           : s->rows_low + (int)(test_random(random) * 5);
    for (int r = 0; r < rows; r++) {
        int width = s->type == WR_ARG_SIZE ? 2 : s->components > 0 ? s->components : 1;
        while (s->counts && !(s->counts >> width & 1)) width--;
        wr_text_add(line, r ? ";" : "");
        for (int i = 0; i < width; i++) {
            wr_text_add(line, !i ? "" : s->type == WR_ARG_SIZE ? "x" : ",");
            add_number(s, i, random, line);
        }
    }
}

/* A line of that form with random arguments; false if it needs a file. */
static bool make_line(const WrCommand *command, int form, TestRandom *random, WrText *line)
{
    WrArgSpec specs[WR_ARGS_MAX];
    WrForm row;
    int count = wr_command_specs(command, form, specs);
    wr_text_clear(line);
    wr_text_add(line, command->name);
    if (form >= 0 && command->form(form, &row)) wr_text_addf(line, " %s", row.name);
    for (int i = 0; i < count; i++) {
        bool file = specs[i].type == WR_ARG_PATH || specs[i].type == WR_ARG_TEXT ||
                    specs[i].type == WR_ARG_SHA256;
        if (file && specs[i].required) return false;
        bool size = strcmp(specs[i].name, "width") == 0 || strcmp(specs[i].name, "height") == 0;
        if (file || (!specs[i].required && !(size && specs[i].whole) && test_random(random) < 0.5))
            continue;
        wr_text_add(line, " ");
        if (!specs[i].positional) wr_text_addf(line, "%s=", specs[i].name);
        add_value(&specs[i], random, line);
    }
    return true;
}

/* Any command except output; paint, layers and selections with higher probability. */
static void random_line(TestRandom *random, WrText *line)
{
    static const char *const often[] = { "dab",    "stroke", "layer", "select",
                                         "adjust", "undo",   "redo" };
    for (;;) {
        const WrCommand *command =
            wr_commands[(int)(test_random(random) * (double)wr_command_count)];
        if (test_random(random) < 0.7)
            command = wr_command_find(often[(int)(test_random(random) * 7)]);
        WrForm row;
        int forms = 0;
        if (command->kind == WR_CLASS_OUTPUT || strcmp(command->name, "history") == 0) continue;
        while (command->form && command->form(forms, &row)) forms++;
        if (make_line(command, forms ? (int)(test_random(random) * forms) : -1, random, line))
            return;
    }
}

/* Hash of everything that undo restores; the view is not included (test_views.c). */
static WrHash hash_of_edits(const WrSession *session)
{
    WrText all = { 0 }, rest = { 0 };
    wr_session_scene_text(session, &all);
    for (const char *p = wr_text_get(&all); *p; p += strcspn(p, "\n") + 1)
        if (strncmp(p, "rotate", 6) != 0 && strncmp(p, "camera", 6) != 0)
            wr_text_add_n(&rest, p, strcspn(p, "\n") + 1);
    WrHash hash = wr_document_hash(doc(session), wr_text_get(&rest));
    wr_text_fini(&all);
    wr_text_fini(&rest);
    return hash;
}

static bool has_edits(const WrSession *session, WrHash hash)
{
    return wr_hash_equal(hash, hash_of_edits(session));
}

typedef struct Walk {
    WrSession *session;
    WrHash *hashes; /* [steps + 2] of the states; 0 is the empty start */
    int failed;
} Walk;

static Walk random_walk(int steps, uint64_t seed, WrPool *pool)
{
    WrSessionOptions options = { .pool = pool };
    Walk walk = { wr_session_new(&options), wr_alloc((size_t)steps + 2, sizeof(WrHash)), 0 };
    TestRandom random = { seed };
    WrText line = { 0 };
    walk.hashes[0] = hash_of_edits(walk.session);
    must_run(walk.session, "table 120x90");
    walk.hashes[1] = hash_of_edits(walk.session);
    for (int i = 0; i < steps; i++) {
        WrError err = { "" };
        int before = wr_session_history_position(walk.session);
        random_line(&random, &line);
        bool good = wr_session_run(walk.session, wr_text_get(&line), &err);
        int now = wr_session_history_position(walk.session);
        if (!good) {
            assert_true(err.text[0] != '\0' && now == before);
            walk.failed++;
        }
        if (good && now == before + 1 && strncmp(wr_text_get(&line), "redo", 4) != 0)
            walk.hashes[now] = hash_of_edits(walk.session);
        else if (!has_edits(walk.session, walk.hashes[now]))
            fail_msg("%s\n  does not give state %d back", wr_text_get(&line), now);
        if (now == 0) must_run(walk.session, "redo"); /* the small table again */
    }
    wr_text_fini(&line);
    return walk;
}

static void random_commands_undo_redo_and_replay_bit_for_bit(void **state)
{
    (void)state;
    int steps = count_of(1000);
    const char *chosen = getenv("WR_SEED");
    uint64_t seed = chosen ? strtoull(chosen, NULL, 10) : 20250711;
    print_message("seed %llu, %d commands\n", (unsigned long long)seed, steps);
    WrError err;
    WrPool *first = wr_pool_new(3);
    Walk walk = random_walk(steps, seed, first);
    WrSession *s = walk.session;
    assert_true(4 * walk.failed < 3 * steps); /* about two in five are not applicable */
    WrHash end = wr_session_hash(s);
    int position = wr_session_history_position(s);
    if (!wr_session_save_history(s, "walk.wrinkle", &err)) fail_msg("%s", err.text);
    for (int i = position - 1; i >= 1; i--) {
        must_run(s, "undo");
        assert_true(has_edits(s, walk.hashes[i]));
    }
    for (int i = 2; i <= position; i++) {
        must_run(s, "redo");
        assert_true(has_edits(s, walk.hashes[i]));
    }
    assert_true(has_hash(s, end));
    const int threads[] = { 1, 2, 7 };
    for (int i = 0; i < 3; i++) {
        WrPool *pool = wr_pool_new(threads[i]);
        WrSessionOptions options = { .pool = pool };
        WrSession *replay = wr_session_new(&options);
        if (!wr_session_run_script(replay, "walk.wrinkle", &err)) fail_msg("%s", err.text);
        assert_true(has_hash(replay, end));
        wr_session_free(replay);
        wr_pool_free(pool);
    }
    wr_session_free(s);
    wr_free(walk.hashes);
    wr_pool_free(first);
}

/* ---- as a script ---- */

static void check_replay(const char *script, WrHash want)
{
    WrError err;
    WrSession *s = wr_session_new(NULL);
    if (!wr_session_open(s, script, &err)) fail_msg("%s", err.text);
    assert_true(has_hash(s, want));
    wr_session_free(s);
}

static void the_script_of_an_opened_document_opens_it_first(void **state)
{
    (void)state;
    WrError err;
    const uint8_t codes[4] = { 0, 80, 160, 255 };
    assert_int_equal(mkdir("sub", 0777), 0);
    assert_int_equal(mkdir("other", 0777), 0);
    assert_true(wr_image_write_pixels("sub/g.png", 2, 2, 1, WR_PIXEL_U8, true, codes, &err));
    static const char script[] = "image g.png\nadjust resize width=40 height=30\n";
    assert_true(wr_file_write("sub/a.wrinkle", script, sizeof script - 1, &err));
    WrSession *s = wr_session_new(NULL);
    must_run(s, "layer add");
    if (!wr_session_run_script(s, "sub/a.wrinkle", &err)) /* 2x2 onto two layers */
        assert_non_null(strstr(err.text, "fit=table"));
    must_run(s, "undo");
    if (!wr_session_run_script(s, "sub/a.wrinkle", &err)) fail_msg("%s", err.text);
    must_run(s, "layer add moss blend=max");
    must_run(s, "colour sub/g.png");
    must_run(s, "dab 0.1,0.1");
    must_run(s, "undo");
    WrHash hash = wr_session_hash(s);
    const char *places[] = { "h.wrinkle", "sub/h.wrinkle", "other/h.wrinkle" };
    for (int i = 0; i < 3; i++) { /* the picture is found from any place of the script */
        assert_true(wr_session_save_history(s, places[i], &err));
        check_replay(places[i], hash);
    }
    assert_true(wr_session_save(s, "sub/d.exr", &err));
    assert_true(wr_session_open(s, "sub/d.exr", &err));
    assert_true(has_hash(s, hash));
    must_run(s, "dab 0.7,0.2 strength=2");
    must_run(s, "surface torus");
    hash = wr_session_hash(s);
    for (int i = 0; i < 3; i++) {
        assert_true(wr_session_save_history(s, places[i], &err));
        check_replay(places[i], hash);
    }
    char *text;
    size_t length;
    assert_true(wr_file_read("sub/h.wrinkle", 100000, &text, &length, &err));
    assert_true(strncmp(text, "open d.exr sha256=", 18) == 0);
    wr_free(text);
    assert_true(wr_session_save(s, "sub/d.exr", &err)); /* its content has changed */
    WrSession *t = wr_session_new(NULL);
    assert_false(wr_session_open(t, "sub/h.wrinkle", &err));
    assert_non_null(strstr(err.text, "file has changed"));
    wr_session_free(t);
    wr_session_free(s);
}

static void open_is_an_edit_that_can_be_undone(void **state)
{
    (void)state;
    WrError err;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 30x20");
    must_run(s, "surface torus");
    must_run(s, "layer add a");
    WrHash saved = wr_session_hash(s);
    assert_true(wr_session_save(s, "o.exr", &err));
    must_run(s, "table 8x8");
    must_run(s, "surface cone");
    WrHash before = wr_session_hash(s);
    int count = wr_session_history_count(s);
    must_run(s, "open o.exr");
    assert_true(has_hash(s, saved));
    assert_int_equal(wr_session_history_count(s), count + 1);
    must_run(s, "undo");
    assert_true(has_hash(s, before));
    must_fail(s, "open nosuch.exr", "nosuch.exr");
    assert_true(has_hash(s, before));
    assert_true(wr_file_write("bad.exr", "\x76\x2f\x31\x01 no", 7, &err));
    must_fail(s, "open bad.exr", "bad.exr");
    assert_true(has_hash(s, before));
    must_run(s, "redo");
    assert_true(has_hash(s, saved));
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc81_a_thousand_strokes_are_undone_and_redone_bit_for_bit),
        cmocka_unit_test(undo_redo_and_their_limits),
        cmocka_unit_test(undoing_back_to_the_saved_state_makes_it_saved_again),
        cmocka_unit_test(going_back_does_not_reach_snapshots_that_others_hold),
        cmocka_unit_test(a_step_costs_the_tiles_that_it_touches),
        cmocka_unit_test(the_oldest_states_go_when_the_budget_is_full),
        cmocka_unit_test(random_commands_undo_redo_and_replay_bit_for_bit),
        cmocka_unit_test(the_script_of_an_opened_document_opens_it_first),
        cmocka_unit_test(open_is_an_edit_that_can_be_undone),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
