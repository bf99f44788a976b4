/* The command language: parsing, canonical printing, and the table that both use. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "command/command_line.h"
#include "command/help.h"
#include "command/session.h"

static char *canonical(const char *line)
{
    WrCall *call;
    WrError err;
    WrText text = { 0 };
    if (!wr_call_parse(line, false, &call, &err)) fail_msg("%s\n  %s", line, err.text);
    wr_call_print(call, &text);
    wr_call_free(call);
    char *kept = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return kept;
}

static void lines_print_in_canonical_form(void **state)
{
    (void)state;
    const struct {
        const char *line, *canonical;
    } known[] = {
        { "", "" },
        { "   # nothing", "" },
        { "\tfill   0.50\t# half", "fill 0.5" },
        { "fill +1.50#right after", "fill 1.5" },
        { "fill -0", "fill -0" },
        { "table 512x0256 wrap=clamp-u", "table 512x256 wrap=clamp-u" },
        { "dab mode=lower 0.25,.75 radius=12.0", "dab 0.25,0.75 radius=12 mode=lower" },
        { "stroke radius=3 points=0,0;1,1,0.5;0.25,0,1,0,0.5;0,0,1,0,0,2.5",
          "stroke points=0,0;1,1,0.5;0.25,0,1,0,0.5;0,0,1,0,0,2.5 radius=3" },
        { "image \"a b.png\"", "image \"a b.png\"" },
        { "image \"plain.png\" fit=table", "image plain.png fit=table" },
        { "image \"q\\\"b\\\\s.png\"", "image \"q\\\"b\\\\s.png\"" },
        { "image a\\b.png", "image \"a\\\\b.png\"" },
        { "image \"a=b.png\"", "image \"a=b.png\"" },
        { "image dir/a=b.png", "image \"dir/a=b.png\"" },
        { "image \"#1.png\"", "image \"#1.png\"" },
        { "analytic poly c=1,2,-0.125;0,0,3", "analytic poly c=1,2,-0.125;0,0,3" },
        { "analytic fourier terms=1,-2,0.5;3,0,1,95,-45",
          "analytic fourier terms=1,-2,0.5;3,0,1,95,-45" },
        { "analytic off", "analytic off" },
        { "surface torus r=0.25 R=2", "surface torus R=2 r=0.25" },
        { "light strength=2 point at=1,2,3 index=1", "light point at=1,2,3 strength=2 index=1" },
        { "light clear", "light clear" },
        { "export range=0,2 height out.png", "export height out.png range=0,2" },
        { "render \"out.png\" size=6x4", "render out.png size=6x4" },
        { "replicate 1.25e2,-2.5e-1", "replicate 125,-0.25" },
        { "layer add opacity=0.50 \"red moss\" blend=max",
          "layer add \"red moss\" blend=max opacity=0.5" },
        { "layer move to=1 2", "layer move 2 to=1" },
        { "select mode=add lasso points=0,0;1,0;0,1.0",
          "select lasso points=0,0;1,0;0,1 mode=add" },
        { "adjust levels out-low=-1 in-high=.5", "adjust levels in-high=0.5 out-low=-1" },
        { "undo 03", "undo 3" },
        { "dab 0,0 set=\"slow_tracking=2;opaque=.5\" preset=soft tip=\"a b.png\"",
          "dab 0,0 preset=soft set=\"slow_tracking=2;opaque=.5\" tip=\"a b.png\"" },
        { "stroke points=0,0 mirror=uv repeat=3x2 jitter=0.5,90,.25",
          "stroke points=0,0 jitter=0.5,90,0.25 mirror=uv repeat=3x2" },
        { "shape paint=fill ellipse radii=0.1,.2 middle=0.5,0.5 mode=to",
          "shape ellipse at=0.5,0.5 radii=0.1,0.2 paint=fill mode=to" },
        { "select ellipse centre=0.5,0.5 radii=0.1,.2", "select ellipse at=0.5,0.5 radii=0.1,0.2" },
        { "dab at=0.5,.25 radius=3", "dab 0.5,0.25 radius=3" },
        { "flood at=0.5,.25", "flood 0.5,0.25" },
        { "pattern bricks at=0.5,.25", "pattern bricks origin=0.5,0.25" },
        { "image a.exr channel=Depth.Z", "image a.exr layer=Depth.Z" },
        { "colour a.exr channel=diffuse", "colour a.exr layer=diffuse" },
        { "environment a.exr channel=sky", "environment a.exr layer=sky" },
        { "picture normals a.exr channel=n", "picture normals a.exr layer=n" },
        { "flood diagonal=on 0.5,.5", "flood 0.5,0.5 diagonal=on" },
        { "ramp fold=on cone to=1,0 from=0,0", "ramp cone from=0,0 to=1,0 fold=on" },
        { "select flood tolerance=0.5 0.1,0.2", "select flood 0.1,0.2 tolerance=0.5" },
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char *text = canonical(known[i].line), *again = canonical(text);
        assert_string_equal(text, known[i].canonical);
        assert_string_equal(again, text);
        wr_free(text);
        wr_free(again);
    }
}

static void a_quoted_word_keeps_every_byte(void **state)
{
    (void)state;
    WrCall *call;
    WrError err;
    assert_true(wr_call_parse("image \"a # b\\\\c \\\"d\\\" \xc3\xa4.png\"", false, &call, &err));
    assert_string_equal(wr_call_arg(call, "FILE")->text, "a # b\\c \"d\" \xc3\xa4.png");
    wr_call_free(call);
}

/* Each line with words that its message must contain. */
static void mistakes_are_named_with_what_would_be_right(void **state)
{
    (void)state;
    const struct {
        const char *line, *words[4];
    } bad[] = {
        { "fil 1", { "fil", "did you mean fill" } },
        { "qwertz", { "qwertz", "help" } },
        { "dab 0,0 radus=3", { "dab", "radus", "did you mean radius" } },
        { "dab 0,0 radius=-1", { "dab", "radius=-1", "0..", "texels" } },
        { "dab 0,0 radius=big", { "radius=big", "number" } },
        { "dab 0,0 radius=1 radius=1", { "radius", "twice" } },
        { "dab 0,0,0", { "dab", "0,0,0", "2 numbers" } },
        { "dab radius=1", { "u,v", "missing" } },
        { "fill 1 2", { "fill", "\"2\"", "too many" } },
        { "fill 1,5", { "1,5", "number" } },
        { "fill 0x10", { "0x10" } },
        { "fill nan", { "nan", "number" } },
        { "fill 1e999", { "1e999" } },
        { "table 4", { "WxH" } },
        { "table 4x4x4", { "WxH" } },
        { "table 4.5x4", { "whole" } },
        { "table 4x4 wrap=round", { "wrap=round", "periodic", "clamp-u" } },
        { "stroke", { "stroke", "points", "missing" } },
        { "stroke points=0,0;1", { "\"1\"", "u,v[,pressure" } },
        { "stroke points=0,0,1,1", { "u,v[,pressure" } },
        { "stroke points=0,0;", { "points" } },
        { "stroke points=x,0", { "u is \"x\"" } },
        { "analytic", { "KIND", "poly", "fourier", "off" } },
        { "analytic poly", { "c=", "missing" } },
        { "analytic poly c=65,0,1", { "i is \"65\"", "0..64" } },
        { "analytic poly c=1.5,0,1", { "whole" } },
        { "surface tors", { "did you mean torus", "sphere" } },
        { "surface bezier points=0,0,0;1,1,1", { "points" } },
        { "light point to=1,1,1", { "to", "at=" } },
        { "dials aa=blurred", { "aa=blurred", "point", "supersample" } },
        { "image \"open", { "image", "not closed" } },
        { "image a\"b", { "quote" } },
        { "image \"a\"b", { "closing quote" } },
        { "image \"a\\n\"", { "backslash" } },
        { "image x.png sha256=abc", { "64" } },
        { "colour \"\"", { "file name" } },
        { "fill 1\nfill 2", { "0x0a" } },
        { "layer ad", { "ACTION", "did you mean add" } },
        { "layer set 1 blend=maxx", { "blend=maxx", "smooth-max" } },
        { "layer set 1 opacity=1.1", { "opacity=1.1", "0..1" } },
        { "layer move 1 to=0", { "to=0", "1..256" } },
        { "select lasso points=0,0;1,1", { "at least 3" } },
        { "adjust blur sigma=-1", { "adjust blur", "sigma=-1", "texels" } },
        { "adjust invert about=mean", { "about=mean", "range, zero" } },
        { "adjust resize width=20000", { "width=20000", "1..16384" } },
        { "undo 0", { "undo", "1.." } },
        { "dab 0,0 set=slow_traking=2", { "dab", "set", "slow_traking" } },
        { "dab 0,0 set=slow_tracking=much", { "dab", "slow_tracking=much", "0..10" } },
        { "dab 0,0 mode=erode2", { "mode=erode2", "erode", "smear" } },
        { "dab 0,0 jitter=0,181,0", { "jitter", "angle is \"181\"", "0..180" } },
        { "dab 0,0 repeat=65x1", { "repeat=65x1", "1..64" } },
        { "shape circle", { "KIND", "ellipse", "path" } },
        { "shape path points=0,0;1,1", { "at least 4" } },
        { "ramp linear from=0,0", { "to=", "missing" } },
        { "flood 0,0 radius=3", { "flood", "unknown name", "strength=" } },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        WrCall *call = NULL;
        WrError err = { "" };
        if (wr_call_parse(bad[i].line, false, &call, &err)) fail_msg("accepted: %s", bad[i].line);
        assert_null(call);
        for (int k = 0; k < 4 && bad[i].words[k]; k++)
            if (!strstr(err.text, bad[i].words[k]))
                fail_msg("%s\n  gave: %s\n  without: %s", bad[i].line, err.text, bad[i].words[k]);
    }
}

static void a_long_hostile_word_is_cut_in_the_message(void **state)
{
    (void)state;
    char line[2000] = "fill ";
    for (size_t i = 5; i < sizeof line - 3; i += 2) memcpy(line + i, "\xc3\xa9", 3);
    WrCall *call = NULL;
    WrError err;
    assert_false(wr_call_parse(line, false, &call, &err));
    assert_true(strlen(err.text) < 200);
    assert_non_null(strstr(err.text, "\xc3\xa9..."));
}

/* ---- the table ---- */

/* Call `each` for every form of every command. */
static void for_each_form(void (*each)(const WrCommand *command, int form, void *ctx), void *ctx)
{
    WrForm row;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *c = wr_commands[i];
        if (!c->form) each(c, -1, ctx);
        for (int f = 0; c->form && c->form(f, &row); f++) each(c, f, ctx);
    }
}

static void check_row(const WrCommand *command, int form, void *ctx)
{
    (void)ctx;
    WrArgSpec specs[WR_ARGS_MAX];
    int count = wr_command_specs(command, form, specs);
    assert_true(count < WR_ARGS_MAX);
    for (int i = 0; i < count; i++) {
        WrArg arg = { .choice = -1 };
        WrError err;
        WrText text = { 0 };
        assert_non_null(specs[i].help);
        for (int k = 0; k < i; k++) assert_string_not_equal(specs[k].name, specs[i].name);
        wr_arg_fallback_print(&specs[i], &text);
        if (text.length && !wr_arg_parse(&specs[i], "default", wr_text_get(&text), &arg, &err))
            fail_msg("%s %s: its own default is refused: %s", command->name, specs[i].name,
                     err.text);
        wr_arg_fini(&arg);
        wr_text_fini(&text);
    }
}

static void every_row_is_complete_and_its_defaults_are_in_range(void **state)
{
    (void)state;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *c = wr_commands[i];
        assert_true(c->help && c->example && c->run);
        assert_true((c->print != NULL) == (c->kind == WR_CLASS_SCENE || c->kind == WR_CLASS_VIEW));
        assert_ptr_equal(wr_command_find(c->name), c);
        char *text = canonical(c->example);
        assert_memory_equal(text, c->name, strlen(c->name));
        wr_free(text);
    }
    assert_null(wr_command_find("undo?"));
    for_each_form(check_row, NULL);
}

static void brush_defaults_are_the_brushes_own(void **state)
{
    (void)state;
    WrCall *call;
    WrError err;
    WrBrush brush = wr_brush_default();
    assert_true(wr_call_parse("dab 0,0", false, &call, &err));
    assert_true(wr_call_number(call, "radius") == brush.radius);
    assert_true(wr_call_number(call, "hardness") == brush.hardness);
    assert_true(wr_call_number(call, "strength") == brush.strength);
    assert_int_equal(wr_call_choice(call, "mode"), brush.mode);
    assert_true(wr_call_number(call, "to") == brush.to);
    assert_true(wr_call_number(call, "opacity") == brush.opacity);
    assert_true(wr_call_number(call, "flow") == brush.flow);
    assert_int_equal(wr_call_choice(call, "buildup"), brush.buildup);
    assert_true(wr_call_number(call, "spacing") == brush.spacing);
    assert_true(wr_call_number(call, "reach") == brush.reach);
    assert_int_equal(wr_call_choice(call, "pressure"), brush.pressure);
    assert_true(wr_call_number(call, "seed") == (double)brush.seed);
    assert_true(wr_call_number(call, "angle") == brush.angle_deg);
    assert_true(fmax(1, brush.aspect) == wr_call_number(call, "aspect"));
    assert_int_equal(wr_call_choice(call, "follow"), brush.follow);
    wr_call_free(call);
}

/* ---- lines made from the table ---- */

static double part_value(const WrArgSpec *s, int part, TestRandom *random)
{
    double low = s->parts ? s->parts[part].low : s->low;
    double high = s->parts ? s->parts[part].high : s->high;
    bool whole = s->whole || s->type == WR_ARG_SIZE || (s->parts && s->parts[part].whole);
    double scale = test_random(random) < 0.5 ? 1 : exp2(60 * test_random(random) - 30);
    double x = (test_random(random) * 20 - 10) * scale;
    if (whole) x = floor(x);
    if (s->above && x <= low) x = high;
    return x < low ? low : x > high ? high : x;
}

static void add_value(const WrArgSpec *s, TestRandom *random, WrText *line)
{
    static const char *const words[] = { "a.png", "\"b c\"", "../x-y_z.exr", "\"\\\"\\\\\"",
                                         "off" };
    if (s->type == WR_ARG_CHOICE) {
        int count = 0;
        while (wr_arg_word(s, count)) count++;
        wr_text_add(line, wr_arg_word(s, (int)(test_random(random) * count)));
    } else if (s->type == WR_ARG_PATH || s->type == WR_ARG_NAME || s->type == WR_ARG_LAYER ||
               s->type == WR_ARG_PRESET || s->type == WR_ARG_TEXT) {
        wr_text_add(line, words[(int)(test_random(random) * 5)]);
    } else if (s->type == WR_ARG_SHA256) {
        for (int i = 0; i < 64; i++) wr_text_addf(line, "%c", "0123456789abcdefABCDEF"[i % 22]);
    } else {
        bool list = s->type == WR_ARG_LIST;
        int extra = list && s->rows_high > s->rows_low ? (int)(test_random(random) * 4) : 0;
        int rows = list ? s->rows_low + extra : 1;
        for (int r = 0; r < rows; r++) {
            int n = wr_arg_width(s);
            if (s->counts) do
                    n = 1 + (int)(test_random(random) * wr_arg_width(s));
                while (!(s->counts >> n & 1));
            wr_text_add(line, r ? ";" : "");
            for (int i = 0; i < n; i++) {
                char digits[64];
                snprintf(digits, sizeof digits, test_random(random) < 0.5 ? "%.17g" : "%+.17e",
                         part_value(s, i, random));
                wr_text_addf(line, "%s%s", !i ? "" : s->type == WR_ARG_SIZE ? "x" : ",", digits);
            }
        }
    }
}

/* A valid line; skip: index of an argument to leave out, -1 for none. all: with every argument. */
static void make_line(const WrCommand *command, int form, bool all, TestRandom *random,
                      WrText *line)
{
    WrArgSpec specs[WR_ARGS_MAX];
    WrForm row;
    int count = wr_command_specs(command, form, specs);
    wr_text_clear(line);
    wr_text_add(line, command->name);
    if (form >= 0 && command->form(form, &row)) wr_text_addf(line, " %s", row.name);
    for (int i = 0; i < count; i++) {
        if (specs[i].type == WR_ARG_TEXT && !specs[i].may_be_empty)
            continue; /* its content is checked by another module */
        if (!specs[i].required && !all && test_random(random) < 0.5) continue;
        wr_text_add(line, test_random(random) < 0.2 ? " \t " : " ");
        if (!specs[i].positional) wr_text_addf(line, "%s=", specs[i].name);
        add_value(&specs[i], random, line);
    }
    if (test_random(random) < 0.2) wr_text_add(line, " # fill \"1");
}

static void check_same_values(const WrCall *a, const WrCall *b)
{
    assert_ptr_equal(a->command, b->command);
    assert_int_equal(a->form, b->form);
    for (int i = 0; i < a->count; i++) {
        const WrArg *x = &a->args[i], *y = &b->args[i];
        assert_int_equal(x->given, y->given);
        assert_int_equal(x->choice, y->choice);
        assert_int_equal(x->rows, y->rows);
        if (x->text) assert_string_equal(x->text, y->text);
        if (x->numbers)
            assert_memory_equal(x->numbers, y->numbers,
                                (size_t)x->rows * (size_t)wr_arg_width(&a->specs[i]) *
                                    sizeof(double));
    }
}

static void check_round_trips(const WrCommand *command, int form, void *ctx)
{
    WrText line = { 0 }, first = { 0 }, second = { 0 };
    for (int round = 0; round < 60; round++) {
        WrCall *a, *b;
        WrError err;
        make_line(command, form, false, ctx, &line);
        if (!wr_call_parse(wr_text_get(&line), false, &a, &err))
            fail_msg("%s\n  %s", wr_text_get(&line), err.text);
        wr_text_clear(&first);
        wr_text_clear(&second);
        wr_call_print(a, &first);
        if (!wr_call_parse(wr_text_get(&first), false, &b, &err))
            fail_msg("%s\n  %s", wr_text_get(&first), err.text);
        wr_call_print(b, &second);
        assert_string_equal(wr_text_get(&first), wr_text_get(&second));
        check_same_values(a, b);
        wr_call_free(a);
        wr_call_free(b);
    }
    wr_text_fini(&line);
    wr_text_fini(&first);
    wr_text_fini(&second);
}

static void random_lines_of_every_command_survive_print_and_parse(void **state)
{
    (void)state;
    TestRandom random = { 20240611 };
    print_message("seed %llu\n", (unsigned long long)random.state);
    for_each_form(check_round_trips, &random);
}

/* ---- bad values, driven by the table ---- */

typedef struct BadCheck {
    WrSession *session;
    WrText line; /* a valid line before the tested argument */
} BadCheck;

static void expect_refused(BadCheck *check, const char *verb, const char *line)
{
    WrError err = { "" };
    if (wr_session_run(check->session, line, &err)) fail_msg("accepted: %s", line);
    if (!strstr(err.text, verb)) fail_msg("%s\n  does not name %s: %s", line, verb, err.text);
}

/* A valid value, without random choice. */
static void add_right(const WrArgSpec *s, WrText *line)
{
    if (s->type == WR_ARG_CHOICE) wr_text_add(line, wr_arg_word(s, 0));
    else if (s->type >= WR_ARG_PATH) wr_text_add(line, "nosuchfile.png");
    for (int r = 0; s->type <= WR_ARG_LIST && r < (s->type == WR_ARG_LIST ? s->rows_low : 1); r++)
        for (int i = 0; i < wr_arg_width(s); i++) {
            double high = s->parts ? s->parts[i].high : s->high;
            const char *comma = s->type == WR_ARG_SIZE ? "x" : ",";
            wr_text_addf(line, "%s%g", i ? comma : r ? ";" : "", high < 1 ? high : 1.0);
        }
}

/* Insert `bad` for number `part` of the first tuple of an otherwise valid value. */
static void add_wrong_part(const WrArgSpec *s, int part, const char *bad, WrText *line)
{
    WrText right = { 0 };
    add_right(s, &right);
    const char *p = wr_text_get(&right);
    for (int i = 0; i < part; i++) p += strcspn(p, ",x;") + 1;
    wr_text_add_n(line, wr_text_get(&right), (size_t)(p - wr_text_get(&right)));
    wr_text_addf(line, "%s%s", bad, p + strcspn(p, ",x;"));
    wr_text_fini(&right);
}

/* The line with all required arguments except `skip`, up to its position. */
static void begin_line(const WrCommand *command, int form, const WrArgSpec *specs, int count,
                       int skip, WrText *line)
{
    WrForm row;
    wr_text_clear(line);
    wr_text_add(line, command->name);
    if (form >= 0 && command->form(form, &row)) wr_text_addf(line, " %s", row.name);
    for (int i = 0; i < count; i++) {
        if (i == skip || !specs[i].required) continue;
        wr_text_add(line, " ");
        if (!specs[i].positional) wr_text_addf(line, "%s=", specs[i].name);
        add_right(&specs[i], line);
    }
    wr_text_add(line, " ");
    if (skip >= 0 && !specs[skip].positional) wr_text_addf(line, "%s=", specs[skip].name);
}

static void try_number(BadCheck *check, const WrCommand *command, const WrArgSpec *s, int part,
                       const char *bad)
{
    WrText line = { 0 };
    wr_text_add(&line, wr_text_get(&check->line));
    add_wrong_part(s, part, bad, &line);
    expect_refused(check, command->name, wr_text_get(&line));
    wr_text_fini(&line);
}

static void try_numbers(BadCheck *check, const WrCommand *command, const WrArgSpec *s)
{
    static const char *const words[] = { "nan", "inf", "-inf", "x", "1e999", "0x1", "\"\"", "--1" };
    char number[WR_NUMBER_SIZE];
    for (int part = 0; part < wr_arg_width(s); part++) {
        double low = s->parts ? s->parts[part].low : s->low;
        double high = s->parts ? s->parts[part].high : s->high;
        bool whole = s->whole || s->type == WR_ARG_SIZE || (s->parts && s->parts[part].whole);
        try_number(check, command, s, part, wr_number_print(low - 1 - fabs(low), number));
        try_number(check, command, s, part, wr_number_print(high + 1 + fabs(high), number));
        if (whole) try_number(check, command, s, part, "1.5");
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            try_number(check, command, s, part, words[i]);
    }
    WrText line = { 0 };
    wr_text_addf(&line, "%s1,1,1,1,1,1,1,1", wr_text_get(&check->line));
    expect_refused(check, command->name, wr_text_get(&line));
    wr_text_fini(&line);
}

static void check_bad_arguments(const WrCommand *command, int form, void *ctx)
{
    BadCheck *check = ctx;
    WrArgSpec specs[WR_ARGS_MAX];
    int count = wr_command_specs(command, form, specs);
    for (int i = 0; i < count; i++) {
        const WrArgSpec *s = &specs[i];
        begin_line(command, form, specs, count, i, &check->line);
        if (s->required) { /* missing: the line up to the name */
            char *line = wr_strdup(wr_text_get(&check->line));
            line[strlen(line) - (s->positional ? 1 : strlen(s->name) + 2)] = '\0';
            expect_refused(check, command->name, line);
            wr_free(line);
        }
        if (s->type <= WR_ARG_LIST) {
            try_numbers(check, command, s);
            continue;
        }
        if (s->may_be_empty) continue; /* any text is valid */
        WrText line = { 0 };
        wr_text_addf(&line, "%s%s", wr_text_get(&check->line),
                     s->type == WR_ARG_PATH || s->type == WR_ARG_NAME ? "\"\"" : "no-such-value");
        expect_refused(check, command->name, wr_text_get(&line));
        wr_text_fini(&line);
    }
    begin_line(command, form, specs, count, -1, &check->line);
    wr_text_add(&check->line, "nosuchname=1");
    expect_refused(check, command->name, wr_text_get(&check->line));
    begin_line(command, form, specs, count, -1, &check->line);
    wr_text_add(&check->line, "surplus surplus surplus"); /* some accept a value or two */
    expect_refused(check, command->name, wr_text_get(&check->line));
}

static void every_argument_of_every_command_refuses_bad_values(void **state)
{
    (void)state;
    WrSessionOptions options = { 0 }; /* outputs off: an accepted line would write no file */
    BadCheck check = { .session = wr_session_new(&options) };
    WrHash before = wr_session_hash(check.session);
    for_each_form(check_bad_arguments, &check);
    assert_true(wr_hash_equal(before, wr_session_hash(check.session)));
    assert_true(wr_session_revision(check.session) == 0);
    wr_session_free(check.session);
    wr_text_fini(&check.line);
}

/* ---- noise ---- */

static void damage_lines(const WrCommand *command, int form, void *ctx)
{
    TestRandom *random = ctx;
    WrText line = { 0 }, first = { 0 }, second = { 0 };
    for (int round = 0; round < test_amount(200, 50); round++) {
        WrCall *call;
        make_line(command, form, true, random, &line);
        for (int hits = 1 + (int)(test_random(random) * 3); hits > 0; hits--) {
            size_t at = (size_t)(test_random(random) * (double)line.length);
            double kind = test_random(random);
            if (kind < 0.3) line.data[at] = (char)(1 + (int)(test_random(random) * 255));
            else if (kind < 0.8)
                line.data[at] = "=,;x\"\\#- .\t0e"[(int)(test_random(random) * 13)];
            else line.data[line.length = at] = '\0';
            if (line.length == 0) break;
        }
        if (!wr_call_parse(wr_text_get(&line), false, &call, NULL)) continue;
        wr_text_clear(&first);
        wr_text_clear(&second);
        wr_call_print(call, &first);
        wr_call_free(call);
        WrError err;
        if (!wr_call_parse(wr_text_get(&first), false, &call, &err))
            fail_msg("%s\n  from %s\n  %s", wr_text_get(&first), wr_text_get(&line), err.text);
        wr_call_print(call, &second);
        wr_call_free(call);
        assert_string_equal(wr_text_get(&first), wr_text_get(&second));
    }
    wr_text_fini(&line);
    wr_text_fini(&first);
    wr_text_fini(&second);
}

static void damaged_lines_never_crash_and_print_stably_where_they_parse(void **state)
{
    (void)state;
    TestRandom random = { 77 };
    print_message("seed %llu\n", (unsigned long long)random.state);
    for_each_form(damage_lines, &random);
}

/* ---- help ---- */

/* Nesting and strings of the program's JSON text; commas and colons in the correct places. */
static void check_json(const char *json)
{
    char stack[64];
    int depth = 0;
    bool value = false; /* a value has just ended */
    for (const char *p = json; *p; p++) {
        if (*p == ' ' || *p == '\n') continue;
        if (*p == '"') {
            assert_false(value);
            for (p++; *p != '"'; p++) {
                assert_true((unsigned char)*p >= 0x20);
                if (*p == '\\') p++;
            }
            value = true;
        } else if (*p == '{' || *p == '[') {
            assert_false(value);
            assert_true(depth < 63);
            stack[depth++] = *p;
        } else if (*p == '}' || *p == ']') {
            assert_true(depth > 0 && stack[--depth] == (*p == '}' ? '{' : '['));
            assert_true(p[-1] != ',' && p[-1] != ':');
            value = true;
        } else if (*p == ',' || *p == ':') {
            assert_true(value);
            value = false;
        } else {
            assert_false(value);
            size_t n = strcspn(p, ",]} \n");
            double x;
            assert_true(wr_number_parse(p, n, &x) || (n == 4 && !memcmp(p, "true", 4)) ||
                        (n == 4 && !memcmp(p, "null", 4)) || (n == 5 && !memcmp(p, "false", 5)));
            p += n - 1;
            value = true;
        }
    }
    assert_int_equal(depth, 0);
}

/* Requirements of the session, its journal and recovery on every row. */
static void rows_agree_with_what_the_session_does_for_them(void **state)
{
    int back = 0, forward = 0, streams = 0, views = 0;
    (void)state;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *c = wr_commands[i];
        WrArgSpec specs[WR_ARGS_MAX];
        const int count = wr_command_specs(c, -1, specs);
        bool points = false, n = false;
        for (int k = 0; k < count; k++) {
            points = points || strcmp(specs[k].name, "points") == 0;
            n = n || strcmp(specs[k].name, "N") == 0;
        }
        if (c->prework != WR_PREWORK_NONE) assert_int_equal(c->kind, WR_CLASS_EDIT);
        if (c->streams) assert_true(points && c->kind == WR_CLASS_EDIT);
        if (c->steps) assert_true(n && c->kind == WR_CLASS_HISTORY);
        if (c->of_views) assert_int_equal(c->kind, WR_CLASS_HISTORY);
        if (c->print_content || c->in_object || c->of_several || c->print_end)
            assert_non_null(c->print);
        back += c->steps<0, forward += c->steps> 0;
        streams += c->streams, views += c->of_views;
    }
    assert_int_equal(back, 1);
    assert_int_equal(forward, 1);
    assert_int_equal(streams, 2);
    assert_int_equal(views, 1);
}

static void help_covers_every_command_as_text_and_as_json(void **state)
{
    (void)state;
    WrText overview = { 0 }, json = { 0 };
    WrError err;
    wr_help_overview(&overview);
    wr_help_json(&json);
    check_json(wr_text_get(&json));
    for (int i = 0; i < wr_command_count; i++) {
        WrText text = { 0 }, key = { 0 };
        assert_true(wr_help_command(wr_commands[i]->name, &text, &err));
        assert_non_null(strstr(wr_text_get(&text), wr_commands[i]->example));
        assert_non_null(strstr(wr_text_get(&overview), wr_commands[i]->name));
        wr_text_addf(&key, "{\"name\":\"%s\",\"class\":\"%s\"", wr_commands[i]->name,
                     wr_class_names[wr_commands[i]->kind]);
        assert_non_null(strstr(wr_text_get(&json), wr_text_get(&key)));
        wr_text_fini(&text);
        wr_text_fini(&key);
    }
    for (int i = 0; i < WR_SURFACE_COUNT; i++)
        assert_non_null(strstr(wr_text_get(&json), wr_surfaces[i]->help));
    assert_false(wr_help_command("stork", &overview, &err));
    assert_non_null(strstr(err.text, "did you mean stroke"));
    wr_text_fini(&overview);
    wr_text_fini(&json);
}

static void help_tells_each_brush_mode_and_what_it_goes_by(void **state)
{
    (void)state;
    static const char *const painters[] = { "dab", "stroke", "shape", "flood" };
    for (int k = 0; k < 4; k++) {
        WrText text = { 0 };
        assert_true(wr_help_command(painters[k], &text, NULL));
        for (int i = 0; i < WR_BRUSH_MODE_COUNT; i++) {
            char row[32];
            snprintf(row, sizeof row, "\n%21s%s ", "", wr_brush_modes[i].name);
            assert_non_null(strstr(wr_text_get(&text), row));
        }
        assert_non_null(strstr(wr_text_get(&text), "(source=)\n")); /* only clone */
        assert_non_null(strstr(wr_text_get(&text), "(strength= to=)\n"));
        wr_text_fini(&text);
    }
}

static void help_tells_what_a_new_scene_has_where_a_row_keeps(void **state)
{
    (void)state;
    WrText text = { 0 };
    wr_help_initial(wr_command_find("bump"), -1, "mode", &text);
    assert_string_equal(wr_text_get(&text), "blinn");
    wr_text_clear(&text);
    wr_help_initial(wr_command_find("camera"), 1, "fit", &text);
    assert_string_equal(wr_text_get(&text), "on");
    wr_text_clear(&text);
    wr_help_initial(wr_command_find("light"), 0, "index", &text);
    assert_string_equal(wr_text_get(&text), "");
    wr_text_fini(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_print_in_canonical_form),
        cmocka_unit_test(a_quoted_word_keeps_every_byte),
        cmocka_unit_test(mistakes_are_named_with_what_would_be_right),
        cmocka_unit_test(a_long_hostile_word_is_cut_in_the_message),
        cmocka_unit_test(every_row_is_complete_and_its_defaults_are_in_range),
        cmocka_unit_test(brush_defaults_are_the_brushes_own),
        cmocka_unit_test(random_lines_of_every_command_survive_print_and_parse),
        cmocka_unit_test(every_argument_of_every_command_refuses_bad_values),
        cmocka_unit_test(damaged_lines_never_crash_and_print_stably_where_they_parse),
        cmocka_unit_test(rows_agree_with_what_the_session_does_for_them),
        cmocka_unit_test(help_covers_every_command_as_text_and_as_json),
        cmocka_unit_test(help_tells_each_brush_mode_and_what_it_goes_by),
        cmocka_unit_test(help_tells_what_a_new_scene_has_where_a_row_keeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
