#include "ui/app/state/keys.h"
#include "ui/toolkit/words.h"
#include "ui/app/state/action_list.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"

#include <SDL.h>
#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

#define LINE(name, keys) #name ": " keys "\n"
static const char built_in[] = WR_ACTIONS(LINE) WR_HELD_ACTIONS(LINE) WR_FAMILY_ACTIONS(LINE);
#undef LINE

#define HASH "Hash" /* '#' begins a comment */

typedef struct Binding {
    char *action; /* owned */
    WrKey key;
} Binding;

typedef WR_ARRAY(Binding) Bindings;

struct WrKeyMap {
    Bindings bindings;
};

/* ---- the keyboard's layout ---- */

SDL_Keycode (*wr_keys_layout)(SDL_Scancode place) = SDL_GetKeyFromScancode;

static bool on_some_key(SDL_Keycode code)
{
    for (int place = 1; place < SDL_NUM_SCANCODES; place++)
        if (wr_keys_layout((SDL_Scancode)place) == code) return true;
    return false;
}

static bool is_sign(SDL_Keycode code)
{
    return code > SDLK_SPACE && code < 127 && !isalpha((int)code);
}

/* Layouts without a key for brackets have them, and other signs, behind AltGr. */
static bool holds_altgr(int held)
{
    return (held & KMOD_MODE) || ((held & KMOD_RALT) && !on_some_key(SDLK_LEFTBRACKET));
}

int wr_key_mods(SDL_Keymod held)
{
    const bool alt = (held & KMOD_LALT) || ((held & KMOD_RALT) && !holds_altgr(held));
    return ((held & KMOD_CTRL) ? WR_MOD_CTRL : 0) | ((held & KMOD_SHIFT) ? WR_MOD_SHIFT : 0) |
           (alt ? WR_MOD_ALT : 0);
}

static const struct {
    const char *name;
    int mod;
} held_mods[] = { { "Ctrl+", WR_MOD_CTRL }, { "Shift+", WR_MOD_SHIFT }, { "Alt+", WR_MOD_ALT } };

/* Length of a trailing modifier name ("Shift"), a key that is only held; 0 if there is none. */
static int held_alone(const char *at, const char *end)
{
    for (size_t m = 0; m < 3; m++) {
        size_t n = strlen(held_mods[m].name) - 1;
        if ((size_t)(end - at) == n && strncmp(at, held_mods[m].name, n) == 0)
            return held_mods[m].mod;
    }
    return 0;
}

bool wr_key_parse(const char *text, size_t length, WrKey *key, WrError *err)
{
    const char *at = text, *end = text + length;
    WrKey out = { SDLK_UNKNOWN, 0 };
    for (size_t m = 0; m < 3;) {
        size_t n = strlen(held_mods[m].name);
        if ((size_t)(end - at) > n && strncmp(at, held_mods[m].name, n) == 0) {
            out.mods |= held_mods[m].mod;
            at += n;
            m = 0;
        } else {
            m++;
        }
    }
    int held = held_alone(at, end);
    if (held) {
        *key = (WrKey){ SDLK_UNKNOWN, out.mods | held };
        return true;
    }
    char name[32];
    if (end - at < 1 || (size_t)(end - at) >= sizeof name)
        return wr_fail(err, "key '%.*s': a name such as Ctrl+S, [ or F1", (int)length, text);
    memcpy(name, at, (size_t)(end - at));
    name[end - at] = '\0';
    for (char *c = name; *c; c++)
        if (*c == '_' && c != name) *c = ' ';
    if (strcmp(name, HASH) == 0) out.code = SDLK_HASH;
    else if (strncmp(name, "Keypad", 6) != 0 && name[1] == '\0' && name[0] >= 'A' && name[0] <= 'Z')
        out.code = name[0] - 'A' + 'a';
    else out.code = SDL_GetKeyFromName(name);
    if (out.code == SDLK_UNKNOWN)
        return wr_fail(err, "key '%.*s': no key has the name '%s'", (int)length, text, name);
    *key = out;
    return true;
}

/* ---- the key map ---- */

static void drop_action(Bindings *bindings, const char *action)
{
    int kept = 0;
    for (int i = 0; i < bindings->count; i++) {
        if (strcmp(bindings->data[i].action, action) == 0) wr_free(bindings->data[i].action);
        else bindings->data[kept++] = bindings->data[i];
    }
    bindings->count = kept;
}

static void free_bindings(Bindings *bindings)
{
    for (int i = 0; i < bindings->count; i++) wr_free(bindings->data[i].action);
    wr_array_free(bindings);
}

/* Parse one line "action: key key ...", without its end. */
static bool read_line(Bindings *bindings, const char *line, size_t length, WrError *err)
{
    const char *hash = memchr(line, '#', length);
    if (hash) length = (size_t)(hash - line);
    while (length > 0 &&
           (line[length - 1] == ' ' || line[length - 1] == '\r' || line[length - 1] == '\t'))
        length--;
    if (length == 0) return true;
    const char *colon = memchr(line, ':', length), *end = line + length;
    if (!colon || colon == line)
        return wr_fail(err, "'%.*s': a line is 'action: key key ...'", (int)length, line);
    char *action = wr_strndup(line, (size_t)(colon - line));
    drop_action(bindings, action);
    bool ok = true;
    for (const char *at = colon + 1; ok && at < end;) {
        while (at < end && (*at == ' ' || *at == '\t')) at++;
        const char *from = at;
        while (at < end && *at != ' ' && *at != '\t') at++;
        if (at == from) break;
        WrKey key;
        ok = wr_key_parse(from, (size_t)(at - from), &key, err);
        if (ok) wr_array_push(bindings, ((Binding){ wr_strdup(action), key }));
    }
    wr_free(action);
    return ok;
}

bool wr_keys_read(WrKeyMap *map, const char *text, WrError *err)
{
    Bindings fresh = { 0 };
    for (int i = 0; i < map->bindings.count; i++) {
        Binding b = map->bindings.data[i];
        wr_array_push(&fresh, ((Binding){ wr_strdup(b.action), b.key }));
    }
    int number = 1;
    for (const char *at = text; *at; number++) {
        size_t length = strcspn(at, "\n");
        if (!read_line(&fresh, at, length, err)) {
            wr_error_prefix(err, "line %d: ", number);
            free_bindings(&fresh);
            return false;
        }
        at += length + (at[length] == '\n');
    }
    free_bindings(&map->bindings);
    map->bindings = fresh;
    return true;
}

WrKeyMap *wr_keys_new(void)
{
    WrKeyMap *map = wr_alloc(1, sizeof *map);
    WrError err;
    bool ok = wr_keys_read(map, built_in, &err);
    WR_ASSERT(ok);
    (void)ok;
    return map;
}

void wr_keys_free(WrKeyMap *map)
{
    if (!map) return;
    free_bindings(&map->bindings);
    wr_free(map);
}

/* The newest line with a key takes precedence. */
static const char *find(const WrKeyMap *map, SDL_Keycode code, int mods)
{
    for (int i = map->bindings.count - 1; i >= 0; i--) {
        const Binding *b = &map->bindings.data[i];
        if (b->key.code == code && b->key.mods == mods) return b->action;
    }
    return NULL;
}

static bool is_bound(const WrKeyMap *map, SDL_Keycode code)
{
    for (int i = 0; i < map->bindings.count; i++)
        if (map->bindings.data[i].key.code == code) return true;
    return false;
}

/* Positions of the brackets on a US keyboard, and of the keys below them, which replace them where a key beside P has a
   shortcut of its own, such as "+" on German, Spanish and Italian keyboards. */
static const SDL_Scancode brackets[2][2] = { { SDL_SCANCODE_LEFTBRACKET,
                                               SDL_SCANCODE_RIGHTBRACKET },
                                             { SDL_SCANCODE_SEMICOLON, SDL_SCANCODE_APOSTROPHE } };

/* Index of the pair of keys for brackets on a layout without them. */
static int bracket_row(const WrKeyMap *map)
{
    return is_bound(map, wr_keys_layout(brackets[0][0])) ||
           is_bound(map, wr_keys_layout(brackets[0][1]));
}

/* The digit or bracket that the key at that position replaces; SDLK_UNKNOWN: none, or the layout has a key for it. */
static SDL_Keycode sign_by_place(const WrKeyMap *map, SDL_Scancode place)
{
    SDL_Keycode sign = SDLK_UNKNOWN;
    if (place >= SDL_SCANCODE_1 && place <= SDL_SCANCODE_9)
        sign = '1' + (SDL_Keycode)(place - SDL_SCANCODE_1);
    if (place == SDL_SCANCODE_0) sign = '0';
    for (int row = 0; row < 2; row++)
        for (int side = 0; side < 2; side++)
            if (place == brackets[row][side] && row <= bracket_row(map))
                sign = side == 0 ? SDLK_LEFTBRACKET : SDLK_RIGHTBRACKET;
    return sign != SDLK_UNKNOWN && on_some_key(sign) ? SDLK_UNKNOWN : sign;
}

const char *wr_keys_find(const WrKeyMap *map, SDL_Keysym sym)
{
    const int held = wr_key_mods((SDL_Keymod)sym.mod);
    if (sym.sym == SDLK_UNKNOWN || holds_altgr(sym.mod)) return NULL;
    const char *action = find(map, sym.sym, held);
    if (action) return action;
    const SDL_Keycode sign = sign_by_place(map, sym.scancode);
    return sign == SDLK_UNKNOWN ? NULL : find(map, sign, held);
}

const char *wr_keys_find_typed(const WrKeyMap *map, const char *text)
{
    if (!is_sign(text[0]) || text[1] || on_some_key(text[0])) return NULL;
    return find(map, text[0], 0);
}

bool wr_keys_hold(const WrKeyMap *map, const char *action, int held)
{
    for (int i = 0; i < map->bindings.count; i++) {
        const Binding *b = &map->bindings.data[i];
        if (b->key.code == SDLK_UNKNOWN && b->key.mods == held && strcmp(b->action, action) == 0)
            return true;
    }
    return false;
}

/* For modifiers alone, remove the last plus. */
static void drop_plus(char *name)
{
    size_t length = strlen(name);
    if (length > 0) name[length - 1] = '\0';
}

static void print_key(WrKey key, char *buffer, size_t size)
{
    bool only = key.code == SDLK_UNKNOWN;
    snprintf(buffer, size, "%s%s%s%s", key.mods & WR_MOD_CTRL ? "Ctrl+" : "",
             key.mods & WR_MOD_SHIFT ? "Shift+" : "", key.mods & WR_MOD_ALT ? "Alt+" : "",
             only                    ? ""
             : key.code == SDLK_HASH ? HASH
                                     : SDL_GetKeyName(key.code));
    if (only) drop_plus(buffer);
}

/* Key name in the user's language: "Strg+Umschalt+Entf". Translations use the context "key: Delete", since a key's
   name may differ from the name of an action. */
static void say_key(WrKey key, char *buffer, size_t size)
{
    char bare[32], id[40];
    print_key((WrKey){ key.code, 0 }, bare, sizeof bare);
    snprintf(id, sizeof id, "key: %s", bare);
    const char *said = wr_words(id);
    snprintf(buffer, size, "%s%s%s%s", key.mods & WR_MOD_CTRL ? wr_words("Ctrl+") : "",
             key.mods & WR_MOD_SHIFT ? wr_words("Shift+") : "",
             key.mods & WR_MOD_ALT ? wr_words("Alt+") : "", said == id ? bare : said);
    if (key.code == SDLK_UNKNOWN) drop_plus(buffer);
}

/* The key to press on this keyboard: a digit or bracket missing in its layout is replaced by the key at its position.
 * False: the layout has no such key, or the key has no name. */
static bool on_this_layout(const WrKeyMap *map, WrKey key, WrKey *pressed)
{
    SDL_Scancode place = SDL_SCANCODE_UNKNOWN;
    *pressed = key;
    if (!is_sign(key.code) || on_some_key(key.code)) return true;
    if (key.code == SDLK_LEFTBRACKET) place = brackets[bracket_row(map)][0];
    if (key.code == SDLK_RIGHTBRACKET) place = brackets[bracket_row(map)][1];
    if (isdigit((int)key.code))
        place = key.code == '0' ? SDL_SCANCODE_0 : SDL_SCANCODE_1 + (key.code - '1');
    pressed->code = place ? wr_keys_layout(place) : SDLK_UNKNOWN;
    return SDL_GetKeyName(pressed->code)[0] && !find(map, pressed->code, key.mods);
}

/* Keys of an action, separated by two spaces, at most `most`. Signs that need Shift or AltGr follow only if there are no
   others: another key may type them too. */
static void list_keys(const WrKeyMap *map, const char *action, int most, WrText *out)
{
    int count = 0;
    for (int typed = 0; typed <= 1 && count == 0; typed++)
        for (int i = 0; i < map->bindings.count && count < most; i++) {
            const Binding *b = &map->bindings.data[i];
            char name[64];
            WrKey key = b->key;
            if (strcmp(b->action, action) != 0) continue;
            if (typed ? !is_sign(key.code) || key.mods : !on_this_layout(map, b->key, &key))
                continue;
            say_key(key, name, sizeof name);
            wr_text_addf(out, "%s%s", count++ > 0 ? "  " : "", name);
        }
}

char *wr_keys_label(const WrKeyMap *map, const char *action, char buffer[32])
{
    WrText list = { 0 };
    list_keys(map, action, 1, &list);
    snprintf(buffer, 32, "%s", wr_text_get(&list));
    wr_text_fini(&list);
    return buffer;
}

void wr_keys_list(const WrKeyMap *map, const char *action, WrText *out)
{
    list_keys(map, action, INT_MAX, out);
}

/* ---- changes ---- */

const char *wr_keys_owner(const WrKeyMap *map, WrKey key)
{
    return find(map, key.code, key.mods);
}

void wr_keys_unbind_all(WrKeyMap *map, const char *action)
{
    drop_action(&map->bindings, action);
}

void wr_keymap_bind(WrKeyMap *map, const char *action, WrKey key)
{
    Bindings *bindings = &map->bindings;
    int kept = 0;
    drop_action(bindings, action);
    for (int i = 0; i < bindings->count; i++) {
        const WrKey has = bindings->data[i].key;
        if (has.code == key.code && has.mods == key.mods) wr_free(bindings->data[i].action);
        else bindings->data[kept++] = bindings->data[i];
    }
    bindings->count = kept;
    wr_array_push(bindings, ((Binding){ wr_strdup(action), key }));
}

/* Write the name as one word. */
static char *join(char *name)
{
    for (char *c = name; *c; c++)
        if (*c == ' ') *c = '_';
    return name;
}

/* Print "action: Ctrl+S Keypad_+\n". */
static void print_line(const WrKeyMap *map, const char *action, WrText *out)
{
    char name[32];
    wr_text_addf(out, "%s:", action);
    for (int i = 0; i < map->bindings.count; i++) {
        if (strcmp(map->bindings.data[i].action, action) != 0) continue;
        print_key(map->bindings.data[i].key, name, sizeof name);
        wr_text_addf(out, " %s", join(name));
    }
    wr_text_add(out, "\n");
}

/* True if the line belongs to the action. */
static bool is_of(const char *line, const char *action)
{
    const size_t length = strlen(action);
    return strncmp(line, action, length) == 0 && line[length] == ':';
}

void wr_keys_edit(const WrKeyMap *map, const char *action, const char *text, WrText *out)
{
    for (const char *at = text; *at;) {
        const size_t length = strcspn(at, "\n");
        if (!is_of(at, action)) wr_text_addf(out, "%.*s\n", (int)length, at);
        at += length + (at[length] == '\n');
    }
    print_line(map, action, out);
}

bool wr_key_can_be_given(SDL_Keycode code)
{
    static const SDL_Keycode never[] = { SDLK_UNKNOWN, SDLK_ESCAPE,     SDLK_LCTRL,
                                         SDLK_RCTRL,   SDLK_LSHIFT,     SDLK_RSHIFT,
                                         SDLK_LALT,    SDLK_RALT,       SDLK_LGUI,
                                         SDLK_RGUI,    SDLK_MODE,       SDLK_CAPSLOCK,
                                         SDLK_SPACE,   SDLK_SCROLLLOCK, SDLK_NUMLOCKCLEAR,
                                         SDLK_MENU,    SDLK_APPLICATION };
    for (size_t i = 0; i < sizeof never / sizeof *never; i++)
        if (code == never[i]) return false;
    char name[32];
    WrKey key;
    print_key((WrKey){ code, 0 }, name, sizeof name); /* parsed as in a file */
    return wr_key_parse(join(name), strlen(name), &key, NULL) && key.code == code && key.mods == 0;
}

/* ---- built-in key maps, in the format of a user's key file ---- */

WR_ROWS(wr_key_maps);
const WrKeyMapText wr_key_maps[WR_KEY_MAPS] = {
    [WR_ROW(WR_KEYS_PAINT)] = { .label = "Paint",
                                .help = "Ctrl picks a height, Shift and dragging sizes the brush; "
                                        "Alt swaps raise and lower",
                                .text = "" },
    [WR_ROW(
        WR_KEYS_SCULPT)] = { .label = "Sculpt",
                             .help =
                                 "Ctrl swaps raise and lower, Shift smooths; Alt picks a height",
                             .text = "hold_invert: Ctrl\n"
                                     "hold_smooth: Shift\n"
                                     "hold_pick: Alt\n"
                                     "hold_size: Alt+Shift\n" },
};
WR_ROWS_END(wr_key_maps, WR_KEY_MAPS);
