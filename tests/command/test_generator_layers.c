/* Generator layers: the bits of the plain commands, changes of values, layers below, refusals, files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/commands.h"
#include "document/document_file.h"
#include "generate/generator.h"
#include "image/image.h"

#define GROUND "table 97x61", "noise gradient cells=3 amplitude=0.731 level=0.113 seed=29"

static WrSession *ground(void)
{
    return session_of((const char *[]){ GROUND, NULL });
}

/* The line in a from= argument: quotes and backslashes are escaped. */
static void add_from(WrText *text, const char *line)
{
    wr_text_add(text, "from=");
    wr_text_add_word(text, line);
}

static void add_layer(WrSession *s, const char *line)
{
    WrText text = { 0 };
    wr_text_add(&text, "layer add made ");
    add_from(&text, line);
    must_run(s, wr_text_get(&text));
    wr_text_fini(&text);
}

static void change(WrSession *s, const char *words)
{
    WrText text = { 0 };
    wr_text_add(&text, "layer set made change=");
    wr_text_add_word(&text, words);
    must_run(s, wr_text_get(&text));
    wr_text_fini(&text);
}

static const WrLayer *made(const WrSession *s)
{
    return &doc(s)->layers[1];
}

/* The composite has the bits of the plain command on the ground. */
static void compare(const char *line)
{
    WrSession *plain = ground(), *layered = ground();
    must_run(plain, line);
    add_layer(layered, line);
    assert_non_null(made(layered)->line);
    if (!same_field(wr_document_field(doc(plain)), wr_document_field(doc(layered))))
        fail_msg("%s: the layer differs from the command", line);
    wr_session_free(plain);
    wr_session_free(layered);
}

static void write_files(void)
{
    static const char drawing[] =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"7\">"
        "<circle cx=\"4.1\" cy=\"3.3\" r=\"2.7\"/></svg>";
    static const char mesh[] = "v 0 0 0\nv 4 0 1\nv 4 4 2\nv 0 4 3\nf 1 2 3 4\n";
    uint8_t texels[768];
    uint16_t codes[64];
    WrError err;
    for (int k = 0; k < 768; k++) texels[k] = (uint8_t)(128 + (k * 37) % 91);
    for (int k = 0; k < 64; k++) codes[k] = (uint16_t)(k * k * 11);
    if (!wr_file_write("a.obj", mesh, strlen(mesh), &err) ||
        !wr_file_write("a.svg", drawing, strlen(drawing), &err) ||
        !wr_file_write("a.r16", codes, sizeof codes, &err) ||
        !wr_image_write_pixels("a.png", 16, 16, 3, WR_PIXEL_U8, true, texels, &err))
        fail_msg("%s", err.text);
}

static const char *file_for(const WrGenerator *row)
{
    if (strcmp(row->family, "solid") == 0) return "a.obj";
    if (strcmp(row->name, "svg") == 0) return "a.svg";
    return strcmp(row->family, "terrain") == 0 ? "a.r16 size=8x8" : "a.png";
}

/* A line of this row: defaults, and small values for the required ones. */
static void line_of(const WrGenerator *row, WrText *line)
{
    wr_text_clear(line);
    wr_text_add(line, row->family);
    if (row->name) wr_text_addf(line, " %s", row->name);
    for (const WrParam *p = row->params; p->name; p++) {
        if (p->kind == WR_PARAM_TERMS)
            wr_text_addf(line, " %s=%s", p->name,
                         p->fewest == 3 ? "2,1,0.37;0,3,0.21" : "2,1,0.37,20,0");
        if (p->fallback_text) continue;
        if (p->kind == WR_PARAM_TEXT) wr_text_add(line, " \"Aq & \\\\n\\\"b\\\"\"");
        if (p->kind == WR_PARAM_FILE) wr_text_addf(line, " %s", file_for(row));
    }
}

static void every_generator_as_a_layer_has_the_bits_of_its_command(void **state)
{
    (void)state;
    write_files();
    WrText line = { 0 };
    int rows = 0;
    for (const WrFamily *family = wr_families; family->name; family++)
        for (const WrGenerator *row = family->rows; row->family; row++, rows++) {
            line_of(row, &line);
            compare(wr_text_get(&line));
            /* each mode in turn, over and over */
            const char *own = wr_generator_argument(row, "radius");
            const char *mode = wr_blends[(rows * 4 + 1) % WR_BLEND_COUNT].name;
            wr_text_addf(&line, " %s=%s %s=0.237 %s=0.0613", wr_generator_argument(row, "blend"),
                         mode, own, wr_generator_argument(row, "offset"));
            compare(wr_text_get(&line));
        }
    assert_true(rows > 40);
    wr_text_fini(&line);
}

static void shapes_and_ramps_are_layers_too(void **state)
{
    (void)state;
    static const char *const shapes[] = {
        "shape ellipse at=0.41,0.53 radii=0.23,0.31 paint=fill strength=0.317",
        "shape rectangle a=0.1,0.2 b=0.71,0.83 paint=outline radius=5 strength=0.123"
    };
    for (int i = 0; i < 2;
         i++) { /* brushes raise heights in double: equal on a layer of their own */
        WrSession *plain = ground(), *layered = ground();
        must_run(plain, "layer add");
        must_run(plain, shapes[i]);
        add_layer(layered, shapes[i]);
        assert_true(same_field(made(plain)->heights, made(layered)->heights));
        assert_true(same_field(made(plain)->cover, made(layered)->cover));
        wr_session_free(plain);
        wr_session_free(layered);
    }
    compare("ramp linear from=0.13,0.5 to=0.61,0.4 low=-0.317 high=1.13");
    compare("ramp radial from=0.13,0.5 to=0.61,0.4 blend=max");
    compare("ramp cone from=0.13,0.5 to=0.61,0.4 blend=add");
}

static void a_changed_value_gives_the_layer_of_a_line_with_that_value(void **state)
{
    (void)state;
    WrSession *s = ground(), *other = ground();
    add_layer(s, "text Helo size=23 height=0.31 at=0.4,0.6");
    const WrHash first = wr_session_hash(s);
    change(s, "size=31.5 Hello");
    assert_non_null(strstr(made(s)->line, "text Hello size=31.5 at=0.4,0.6 height=0.31"));
    add_layer(other, "text Hello size=31.5 at=0.4,0.6 height=0.31");
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    change(s, "font=serif"); /* another file, another checksum */
    assert_false(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    must_run(s, "undo");
    must_run(s, "undo");
    assert_true(wr_hash_equal(wr_session_hash(s), first));
    must_run(s, "redo");
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(other)));
    must_run(s, "layer set made from=\"pattern dots across=3\"");
    assert_string_equal(made(s)->line, "pattern dots across=3");
    must_fail(s, "layer set made change=\"acros=3\"", "did you mean across=");
    must_fail(s, "layer set made change=\"across=3 across=4\"", "given twice");
    must_fail(s, "layer set made change=\"across=-3\"", "must be");
    must_fail(s, "layer set 1 change=\"across=3\"", "is not a generator layer");
    must_fail(s, "layer add x from=\"undo\"", "generates no layer");
    must_fail(s, "layer add x from=\"pattern dott\"", "did you mean dots");
    must_run(s, "layer set made lock=on");
    must_fail(s, "layer set made change=\"across=4\"", "locked");
    wr_session_free(s);
    wr_session_free(other);
}

/* The mode belongs to the layer: its content follows when coverage begins to count. */
static void the_blend_mode_is_the_layers(void **state)
{
    (void)state;
    static const char line[] = "text Wri size=29.3 height=0.417";
    WrSession *s = ground(), *plain = ground();
    add_layer(s, line);
    assert_int_equal(made(s)->blend, WR_BLEND_ADD);
    must_run(s, "layer set made blend=smooth-max radius=0.173");
    must_run(plain, "text Wri size=29.3 height=0.417 blend=smooth-max radius=0.173");
    assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(plain))));
    change(s, "blend=add");
    must_run(plain, "undo");
    must_run(plain, line);
    assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(plain))));
    assert_null(strstr(made(s)->line, "blend"));
    wr_session_free(s);
    wr_session_free(plain);
}

static void a_line_that_reads_heights_follows_the_layers_below(void **state)
{
    (void)state;
    WrSession *s = ground(), *plain = ground();
    add_layer(s, "terrain terraces steps=5");
    must_run(s, "layer use 1");
    must_run(s, "dab 0.31,0.77 radius=9.7 strength=0.613");
    must_run(plain, "dab 0.31,0.77 radius=9.7 strength=0.613");
    must_run(plain, "terrain terraces steps=5");
    assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(plain))));
    /* a line that reads none is not run again: its tiles are the same ones */
    must_run(s, "layer use 2");
    must_run(s, "layer add dots from=\"pattern dots across=3 blend=add\"");
    must_run(s, "layer use 1");
    const uint64_t key = wr_field_key(doc(s)->layers[2].heights);
    must_run(s, "dab 0.5,0.5 radius=5");
    assert_int_equal(wr_field_key(doc(s)->layers[2].heights), key);
    /* neither is a hidden one, until it is shown */
    must_run(s, "layer set 2 visible=off");
    const uint64_t hidden = wr_field_key(made(s)->heights);
    must_run(s, "dab 0.7,0.2 radius=5");
    assert_int_equal(wr_field_key(made(s)->heights), hidden);
    must_run(s, "layer set 2 visible=on");
    assert_int_not_equal(wr_field_key(made(s)->heights), hidden);
    wr_session_free(s);
    wr_session_free(plain);
}

static void other_edits_of_its_heights_are_refused_or_make_it_plain(void **state)
{
    (void)state;
    Said said;
    WrSession *s = listening(&said);
    must_run(s, "table 97x61");
    must_run(s, "select rect from=0.1,0.2 to=0.6,0.7");
    add_layer(s, "pattern dots across=3");
    assert_non_null(made(s)->mask); /* the selection */
    static const char *const edits[] = { "dab 0.5,0.5 radius=4", "fill 1",
                                         "adjust blur sigma=1",  "pattern dots",
                                         "transform move=3,0",   "flood 0.5,0.5 to=1" };
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++)
        must_fail(s, edits[i], "layer rasterize 2");
    must_run(s, "layer use made part=mask");
    must_run(s, "dab 0.5,0.5 radius=4 mode=to to=0");
    assert_non_null(made(s)->line);
    said.text[0] = '\0';
    must_run(s, "layer use made part=heights");
    must_run(s, "select none");
    must_run(s, "adjust offset du=7 layers=all");
    assert_null(made(s)->line);
    assert_non_null(strstr(said.text, "is a plain layer now"));
    must_run(s, "undo");
    assert_non_null(made(s)->line);
    const WrHash seen = wr_field_hash(wr_document_field(doc(s)));
    must_run(s, "layer rasterize made");
    assert_true(wr_hash_equal(seen, wr_field_hash(wr_document_field(doc(s)))));
    must_run(s, "dab 0.5,0.5 radius=4");
    must_fail(s, "layer rasterize made", "is already a plain layer");
    must_run(s, "undo 2");
    must_run(s, "layer duplicate made");
    assert_string_equal(doc(s)->layers[2].line, made(s)->line);
    must_run(s, "layer merge 3");
    assert_null(made(s)->line);
    wr_session_free(s);
}

static void save_and_open(const char *name)
{
    char line[100];
    WrSession *s = ground(), *again = ground();
    WrSessionOptions options = { .outputs = true };
    WrSession *writer = wr_session_new(&options);
    add_layer(s, "text Hello size=23.7 height=0.31");
    must_run(writer, "table 97x61");
    must_run(writer, "noise gradient cells=3 amplitude=0.731 level=0.113 seed=29");
    add_layer(writer, "text Hello size=23.7 height=0.31");
    must_run(writer, "layer add worn from=\"terrain terraces steps=7\"");
    snprintf(line, sizeof line, "save %s", name);
    must_run(writer, line);
    snprintf(line, sizeof line, "open %s", name);
    must_run(again, line);
    assert_true(wr_hash_equal(wr_session_hash(writer), wr_session_hash(again)));
    assert_string_equal(made(again)->line, made(s)->line);
    change(again, "size=31");
    change(writer, "size=31");
    assert_true(wr_hash_equal(wr_session_hash(writer), wr_session_hash(again)));
    wr_session_free(s);
    wr_session_free(again);
    wr_session_free(writer);
}

static void files_keep_the_line(void **state)
{
    (void)state;
    save_and_open("kept.exr");
    save_and_open("kept.ora");
}

/* As a program of another version would write them. */
static void a_line_that_is_not_known_leaves_the_heights(void **state)
{
    (void)state;
    static const char *const lines[] = { "weather storm=3", "export png a.png", "undo", "dots \"" };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrSession *s = ground();
        add_layer(s, "pattern dots across=3");
        WrDocument *document = wr_document_share(doc(s));
        WrHash seen = wr_field_hash(wr_document_field(document));
        WrError err;
        wr_layer_set_line(&document->layers[1], lines[i], (WrHash){ 0, 0 });
        if (!wr_document_save(document, "", "odd.exr", NULL, &err)) fail_msg("%s", err.text);
        wr_document_free(document);
        Said said;
        WrSession *other = listening(&said);
        must_run(other, "open odd.exr");
        assert_non_null(strstr(said.text, "its command is unknown to this version"));
        assert_true(wr_hash_equal(seen, wr_field_hash(wr_document_field(doc(other)))));
        must_run(other, "layer use 1");
        must_run(other, "dab 0.5,0.5 radius=4");
        must_fail(other, "layer set made change=\"across=4\"", "is unknown to this version");
        must_run(other, "save odd.ora"); /* and it stays writable, with the line */
        must_run(other, "open odd.ora");
        assert_string_equal(made(other)->line, lines[i]);
        must_run(other, "layer set made from=\"pattern dots across=4\"");
        wr_session_free(other);
        wr_session_free(s);
    }
}

static void the_lines_files_are_named_for_good(void **state)
{
    (void)state;
    write_files();
    WrSessionOptions options = { .outputs = true };
    WrSession *s = wr_session_new(&options), *again;
    must_run(s, "table 97x61");
    add_layer(s, "picture photo a.png");
    assert_non_null(strstr(made(s)->line, "/a.png"));
    assert_non_null(strstr(made(s)->line, "sha256="));
    must_run(s, "script all.wrinkle");
    again = wr_session_new(&options);
    WrError err;
    if (!wr_session_run_script(again, "all.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(again), wr_session_hash(s)));
    assert_int_equal(remove("a.png"), 0);
    must_fail(s, "layer set made change=\"height=0.7\"", "a.png");
    assert_non_null(made(s)->line);
    wr_session_free(again);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_generator_as_a_layer_has_the_bits_of_its_command),
        cmocka_unit_test(shapes_and_ramps_are_layers_too),
        cmocka_unit_test(a_changed_value_gives_the_layer_of_a_line_with_that_value),
        cmocka_unit_test(the_blend_mode_is_the_layers),
        cmocka_unit_test(a_line_that_reads_heights_follows_the_layers_below),
        cmocka_unit_test(other_edits_of_its_heights_are_refused_or_make_it_plain),
        cmocka_unit_test(files_keep_the_line),
        cmocka_unit_test(a_line_that_is_not_known_leaves_the_heights),
        cmocka_unit_test(the_lines_files_are_named_for_good),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
