/* The document file with all its parts: round trips, newer and older versions, hostile files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <unistd.h>

typedef struct Notes {
    WrText text;
} Notes;

static void keep_note(void *ctx, const char *text)
{
    wr_text_addf(&((Notes *)ctx)->text, "%s\n", text);
}

static WrSession *new_session(Notes *notes)
{
    WrSessionOptions options = { .note = keep_note, .note_ctx = notes };
    return wr_session_new(&options);
}

static void read_bytes(const char *path, char **bytes, size_t *length)
{
    WrError err;
    if (!wr_file_read(path, 1 << 28, bytes, length, &err)) fail_msg("%s", err.text);
}

static void assert_same_files(const char *a, const char *b)
{
    char *one, *two;
    size_t length_one, length_two;
    read_bytes(a, &one, &length_one);
    read_bytes(b, &two, &length_two);
    assert_int_equal(length_one, length_two);
    assert_memory_equal(one, two, length_one);
    wr_free(one);
    wr_free(two);
}

/* Every setting away from its default on some layer. */
static WrSession *rich(Notes *notes)
{
    static const char *const lines[] = {
        "table 100x70 wrap=clamp-u",
        "grid cells=4x3",
        "layer add \"M\xc3\xb6rtel \\\"x\\\"\" blend=smooth-min radius=0.3 opacity=0.1",
        "dab 0.3,0.3 radius=30",
        "select rect from=0.1,0.1 to=0.33,0.77",
        "layer mask 2 from=selection",
        "layer add blend=multiply",
        "stroke points=0,0;1,1,0.3 radius=12 strength=3",
        "layer set 3 visible=off",
        "layer duplicate 2",
        "layer set 3 lock=on opacity=0.33333334",
        "layer add base",
        "dab 0.9,0.9 strength=2",
        "layer solo 2",
        "select feather by=3",
        "layer use 1",
        "surface torus R=2",
    };
    WrSession *session = new_session(notes);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) must_run(session, lines[i]);
    return session;
}

static void save_load_save_gives_the_same_bytes_with_every_part(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *a = rich(&notes), *b = new_session(&notes);
    if (!wr_session_save(a, "a.exr", &err)) fail_msg("%s", err.text);
    if (!wr_session_open(b, "a.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    assert_int_equal(doc(b)->layer_count, 5);
    assert_int_equal(doc(b)->active, 0);
    assert_int_equal(doc(b)->solo, 1);
    const WrLayer *layer = &doc(b)->layers[2];
    assert_string_equal(layer->name, "M\xc3\xb6rtel \"x\" copy");
    assert_int_equal(layer->blend, WR_BLEND_SMOOTH_MIN);
    assert_true(layer->radius == 0.3f && layer->opacity == 0.33333334f && layer->locked);
    assert_true(layer->mask && layer->cover && doc(b)->selection);
    assert_false(doc(b)->layers[4].visible);
    assert_null(doc(b)->layers[0].cover);
    assert_true(wr_field_wrap_u(doc(b)->selection) == WR_WRAP_CLAMP);
    if (!wr_session_save(b, "b.exr", &err)) fail_msg("%s", err.text);
    assert_same_files("a.exr", "b.exr");
    assert_string_equal(wr_text_get(&notes.text), "");
    wr_session_free(a);
    wr_session_free(b);
}

/* Replace a file by a copy of another one, as another program would. */
static void put_in_place(const char *from, const char *to)
{
    char *bytes;
    size_t length;
    WrError err;
    assert_true(wr_file_read(from, 1 << 24, &bytes, &length, &err));
    assert_true(wr_file_write(to, bytes, length, &err));
    wr_free(bytes);
}

static void a_file_that_another_program_has_written_since_is_seen(void **state)
{
    (void)state;
    WrError err;
    Notes notes = { 0 };
    WrSession *s = rich(&notes);
    assert_false(wr_session_file_changed(s)); /* there is no file */
    assert_true(wr_session_save(s, "own.exr", &err));
    assert_false(wr_session_file_changed(s));
    put_in_place("own.exr", "own.exr");
    /* the same bytes in another file: not distinguishable */
    assert_true(wr_session_file_changed(s));
    assert_true(wr_session_open(s, "own.exr", &err));
    assert_false(wr_session_file_changed(s));
    must_run(s, "layer solo off");
    assert_false(wr_session_file_changed(s)); /* unchanged by the session's own save */
    FILE *file = fopen("own.exr", "ae");
    assert_true(file && fputc('x', file) == 'x' && fclose(file) == 0);
    assert_true(wr_session_file_changed(s)); /* in place */
    assert_true(wr_session_save(s, "own.exr", &err));
    assert_false(wr_session_file_changed(s));
    assert_int_equal(remove("own.exr"), 0);
    assert_false(wr_session_file_changed(s)); /* saving loses nothing */
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void the_hash_covers_everything_that_is_saved(void **state)
{
    (void)state;
    static const char *const changes[] = {
        "layer rename 2 x",
        "layer set 2 blend=max",
        "layer set 2 opacity=0.2",
        "layer set 2 radius=0.4",
        "layer set 2 visible=off",
        "layer set 2 lock=on",
        "layer solo off",
        "layer move 2 to=3",
        "layer mask 1 from=white",
        "layer mask 2 from=none",
        "select none",
        "select grow by=1",
        "layer delete 5",
        "bump height=3",
        "fill 7",
        "layer set 3 lock=off",
        "layer add",
    };
    Notes notes = { 0 };
    WrError err;
    WrSession *s = rich(&notes);
    WrHash before = wr_session_hash(s);
    wr_session_save(s, "before.exr", &err);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        if (strcmp(changes[i], "fill 7") == 0) { /* only a visible layer can be filled */
            must_run(s, "layer solo off");
            before = wr_session_hash(s);
        }
        must_run(s, changes[i]);
        if (wr_hash_equal(before, wr_session_hash(s))) fail_msg("%s: the same hash", changes[i]);
        must_run(s, "undo");
        assert_true(wr_hash_equal(before, wr_session_hash(s)));
    }
    char back[32];
    snprintf(back, sizeof back, "layer use %d", doc(s)->active + 1);
    must_run(s, doc(s)->active == 1 ? "layer use 1" : "layer use 2"); /* no step */
    assert_false(wr_hash_equal(before, wr_session_hash(s)));
    must_run(s, back);
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

/* ---- other versions ---- */

typedef struct Part {
    const char *name;
    float value;
    int channels;
} Part;

#define SIDE 70

static bool part_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)y;
    (void)err;
    const Part *part = ctx;
    for (int i = 0; i < rows * SIDE * part->channels; i++) ((float *)out)[i] = part->value;
    return true;
}

static void write_parts(const char *path, const char *version, Part *parts, int count,
                        const WrImageAttribute *of_layers, int attribute_count)
{
    WrImageAttribute of_file[] = { { "wrinkle:version", version },
                                   { "wrinkle:wrap", "periodic" },
                                   { "wrinkle:scene", "surface torus\nsparkle 3\nrotate 1,2,3\n" },
                                   { "wrinkle:active", "2" },
                                   { "wrinkle:solo", "many" } };
    WrImageOut outs[8];
    WrError err = { "" };
    for (int i = 0; i < count; i++) {
        bool layer = strncmp(parts[i].name, "layer:", 6) == 0;
        outs[i] = (WrImageOut){ .width = SIDE,
                                .height = SIDE,
                                .channels = parts[i].channels,
                                .type = WR_PIXEL_F32,
                                .part_name = parts[i].name,
                                .data = true,
                                .attributes = i == 0  ? of_file
                                              : layer ? of_layers
                                                      : NULL,
                                .attribute_count = i == 0  ? 5
                                                   : layer ? attribute_count
                                                           : 0,
                                .rows = part_rows,
                                .ctx = &parts[i] };
    }
    if (!wr_image_write(path, outs, count, &err)) fail_msg("%s", err.text);
}

/* The multi-part flag in the second word of an EXR file. */
static bool has_parts(const char *path)
{
    char *bytes;
    size_t length;
    read_bytes(path, &bytes, &length);
    assert_true(length > 8);
    bool parts = ((unsigned char)bytes[5] & 0x10) != 0;
    wr_free(bytes);
    return parts;
}

static WrSession *open_saved(Notes *notes, const char *path)
{
    WrError err = { "" };
    WrSession *s = new_session(notes);
    if (!wr_session_open(s, path, &err)) fail_msg("%s", err.text);
    return s;
}

/* For programs that cannot open multi-part EXR files. */
static void one_layer_that_is_f_is_a_file_of_one_part(void **state)
{
    (void)state;
    Notes notes = { 0 };
    WrError err = { "" };
    WrSession *s = new_session(&notes);
    const char *const lines[] = { "table 100x70 wrap=clamp-v",
                                  "grid cells=4x3",
                                  "dab 0.3,0.3 radius=30",
                                  ("layer rename 1 \"B\xc3\xb6"
                                   "den \\\"1\\\"\""),
                                  "layer set 1 radius=0.25 lock=on",
                                  "surface torus" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) must_run(s, lines[i]);
    assert_true(wr_session_save(s, "one.exr", &err));
    assert_false(has_parts("one.exr"));
    WrSession *t = open_saved(&notes, "one.exr");
    const WrLayer *was = &doc(s)->layers[0], *is = &doc(t)->layers[0];
    assert_int_equal(doc(t)->layer_count, 1);
    assert_string_equal(is->name, was->name);
    assert_true(is->blend == was->blend && is->opacity == was->opacity);
    assert_true(is->radius == 0.25f && is->locked && is->visible);
    assert_int_equal(wr_field_wrap_v(is->heights), WR_WRAP_CLAMP);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(t)));
    for (int y = 0; y < 70; y++)
        for (int x = 0; x < 100; x++)
            assert_true(wr_field_get(is->heights, x, y) == wr_field_get(was->heights, x, y));
    assert_true(wr_session_save(t, "again.exr", &err));
    assert_same_files("one.exr", "again.exr");
    assert_null(strstr(wr_text_get(&notes.text), "newer"));
    wr_session_free(t);
    /* Features beyond F alone need parts; a file saved in that way is still version 2. */
    const char *const further[] = { "layer set 1 lock=off opacity=0.5",
                                    "layer set 1 opacity=1",
                                    "select rect from=0.1,0.1 to=0.5,0.5",
                                    "select none",
                                    "layer add b",
                                    "layer delete 2" };
    for (size_t i = 0; i < sizeof further / sizeof *further; i++) {
        must_run(s, further[i]);
        assert_true(wr_session_save(s, "more.exr", &err));
        if (has_parts("more.exr") != (i % 2 == 0)) fail_msg("after '%s'", further[i]);
        t = open_saved(&notes, "more.exr");
        assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(t)));
        WrImageFile *file = wr_image_file_open("more.exr", &err);
        assert_non_null(file);
        assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:version"),
                            i % 2 == 0 ? "2" : "3");
        wr_image_file_close(file);
        wr_session_free(t);
    }
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void a_newer_version_opens_but_is_not_saved_over(void **state)
{
    (void)state;
    Part parts[] = { { "F", 0, 1 },        { "layer:a", 1, 1 }, { "sparkle:1", 9, 1 },
                     { "layer:b", 2, 1 },  { "cover:2", 5, 1 }, { "colours", 1, 3 },
                     { "selection", 1, 1 } };
    const WrImageAttribute settings[] = { { "wrinkle:blend", "sparkling" },
                                          { "wrinkle:opacity", "half" } };
    Notes notes = { 0 };
    WrError err = { "" };
    char version[16];
    snprintf(version, sizeof version, "%d", WR_DOCUMENT_VERSION + 1);
    write_parts("new.exr", version, parts, 7, settings, 2);
    WrSession *s = new_session(&notes);
    if (!wr_session_open(s, "new.exr", &err)) fail_msg("%s", err.text);
    char said[80];
    snprintf(said, sizeof said, "newer version of the program (document version %s", version);
    assert_non_null(strstr(wr_text_get(&notes.text), said));
    assert_non_null(strstr(wr_text_get(&notes.text), "sparkle"));
    assert_int_equal(doc(s)->layer_count, 2);
    assert_int_equal(doc(s)->active, 1);
    assert_int_equal(doc(s)->solo, -1);
    assert_true(wr_field_get(doc(s)->layers[1].heights, 5, 5) == 2);
    assert_true(wr_field_get(doc(s)->layers[1].cover, 5, 5) == 1); /* limited to 0..1 */
    assert_true(doc(s)->scene->posed);                             /* line after the unknown one */
    char *before, *after;
    size_t length, length_after;
    read_bytes("new.exr", &before, &length);
    must_run(s, "layer solo off");
    assert_int_equal(symlink("new.exr", "link.exr"), 0);
    const char *names[] = { "new.exr", "./new.exr", "link.exr" };
    for (int i = 0; i < 3; i++) {
        assert_false(wr_session_save(s, names[i], &err));
        assert_non_null(strstr(err.text, "newer version"));
    }
    assert_true(wr_session_save(s, "mine.exr", &err));
    assert_string_equal(wr_session_path(s), "mine.exr");
    assert_false(wr_session_save(s, "new.exr", &err));
    assert_true(wr_session_save(s, "mine.exr", &err));
    read_bytes("new.exr", &after, &length_after);
    assert_int_equal(length, length_after);
    assert_memory_equal(before, after, length);
    wr_free(before);
    wr_free(after);
    wr_session_reset(s); /* another document may use the name */
    assert_true(wr_session_save(s, "new.exr", &err));
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

static void what_a_newer_version_may_hold_is_damage_in_this_one(void **state)
{
    (void)state;
    const WrImageAttribute blend[] = { { "wrinkle:blend", "sparkling" } };
    const WrImageAttribute opacity[] = { { "wrinkle:opacity", "1.5" } };
    const WrImageAttribute visible[] = { { "wrinkle:visible", "maybe" } };
    Part good[] = { { "F", 0, 1 },
                    { "layer:a", 1, 1 },
                    { "cover:1", 1, 1 },
                    { "mask:1", 1, 1 },
                    { "layer:b", 1, 1 } };
    Part twice[] = {
        { "F", 0, 1 }, { "layer:a", 1, 1 }, { "cover:1", 1, 1 }, { "cover:1 ", 1, 1 }
    };
    Part wrong[] = { { "F", 0, 1 }, { "layer:a", 1, 1 }, { "cover:2", 1, 1 } };
    Part first[] = { { "F", 0, 1 }, { "mask:1", 1, 1 }, { "layer:a", 1, 1 } };
    Part late[] = { { "F", 0, 1 }, { "layer:a", 1, 1 }, { "selection", 1, 1 }, { "mask:1", 1, 1 } };
    Part wide[] = { { "F", 0, 1 }, { "layer:a", 1, 1 }, { "mask:1", 1, 3 } };
    const struct {
        Part *parts;
        int count;
        const WrImageAttribute *settings;
        const char *word;
    } files[] = { { good, 5, blend, "wrinkle:blend 'sparkling'" },
                  { good, 5, opacity, "wrinkle:opacity '1.5'" },
                  { good, 5, visible, "wrinkle:visible 'maybe'" },
                  { good, 5, NULL, "wrinkle:solo 'many'" },
                  { twice, 4, NULL, "part 'cover:1 ' does not belong" },
                  { wrong, 3, NULL, "part 'cover:2' does not belong" },
                  { first, 3, NULL, "part 'mask:1' does not belong" },
                  { late, 4, NULL, "part 'mask:1' does not belong" },
                  { wide, 3, NULL, "with 3 channels" } };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        WrLoaded loaded;
        int64_t replaced;
        WrError err = { "" };
        write_parts("bad.exr", "2", files[i].parts, files[i].count, files[i].settings,
                    files[i].settings ? 1 : 0);
        assert_false(wr_document_load("bad.exr", &loaded, &replaced, &err));
        if (!strstr(err.text, files[i].word)) fail_msg("%s: no %s", err.text, files[i].word);
    }
}

/* ---- hostile files ---- */

static int count_of(int full)
{
    const char *all = getenv("WR_FULL");
    return all && *all && strcmp(all, "0") != 0 ? full : full / 10;
}

/* The file loads or reports an error; a loaded document is usable. */
static void try_file(const char *path)
{
    WrLoaded loaded = { 0 };
    int64_t replaced;
    WrError err = { "" };
    if (!wr_document_load(path, &loaded, &replaced, &err)) {
        assert_true(err.text[0] != '\0');
        return;
    }
    const WrField *f = wr_document_field(loaded.document);
    float low, high;
    wr_field_range(f, &low, &high);
    assert_true(isfinite(low) && isfinite(high));
    wr_document_free(loaded.document);
    wr_image_free(loaded.pictures[0][WR_OBJECT_COLOUR]);
    wr_free(loaded.scene_text);
}

static void hostile_documents_load_or_say_why_not(void **state)
{
    (void)state;
    int rounds = count_of(1000);
    TestRandom random = { 4711 };
    print_message("seed %llu, %d files\n", (unsigned long long)random.state, rounds);
    Notes notes = { 0 };
    WrError err;
    WrSession *s = rich(&notes);
    assert_true(wr_session_save(s, "whole.exr", &err));
    char *bytes;
    size_t length;
    read_bytes("whole.exr", &bytes, &length);
    size_t header = length < 6000 ? length : 6000; /* region of names and settings */
    for (int i = 0; i < rounds; i++) {
        char *copy = wr_alloc(length, 1);
        size_t keep = length;
        memcpy(copy, bytes, length);
        if (i % 4 == 0) keep = (size_t)(test_random(&random) * (double)length);
        for (int hits = i % 4 == 0 ? 0 : 1 + (int)(test_random(&random) * 4); hits > 0; hits--) {
            size_t room = i % 4 == 1 ? length : header;
            size_t at = (size_t)(test_random(&random) * (double)room);
            if (i % 4 == 2) copy[at] = (char)(copy[at] ^ (1 << (int)(test_random(&random) * 8)));
            else copy[at] = (char)(test_random(&random) * 256);
        }
        assert_true(wr_file_write("hostile.exr", copy, keep, &err));
        wr_free(copy);
        try_file("hostile.exr");
    }
    wr_free(bytes);
    wr_session_free(s);
    wr_text_fini(&notes.text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(save_load_save_gives_the_same_bytes_with_every_part),
        cmocka_unit_test(a_file_that_another_program_has_written_since_is_seen),
        cmocka_unit_test(the_hash_covers_everything_that_is_saved),
        cmocka_unit_test(one_layer_that_is_f_is_a_file_of_one_part),
        cmocka_unit_test(a_newer_version_opens_but_is_not_saved_over),
        cmocka_unit_test(what_a_newer_version_may_hold_is_damage_in_this_one),
        cmocka_unit_test(hostile_documents_load_or_say_why_not),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
