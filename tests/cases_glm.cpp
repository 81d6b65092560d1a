/* A lesson's hard cases evaluated by GLM: compiled twice, in float and (CASES_DOUBLE) with `float` meaning
 * double, from the technique files as they stand.
 *
 * A lesson's cases.h is a list of these, without semicolons; an expression is GLSL that is C++ too:
 *
 *   CASE("name", bound, "unit", expression)
 *       The expression begins with the call of a technique function, perhaps with a .field after it, and is a
 *       float, int, bool or vector. bound is that of |float - double| in each component; the unit may be "".
 *   CASE_FLIP("name", jump, "unit", expression)
 *       A case on a comparison, where float and double may take different branches: these differ by at most
 *       the jump.
 *   CASE_EQUALS("name", bound, "unit", expected, expression)
 *       A case whose value is known by hand: both float evaluations are held against it.
 *   CASE_TEXTURE(name, width, height, expression)
 *       A sampler2D for the cases below it, bilinear and repeating. The texel (x, y) is what the expression
 *       (C++ and GLSL's vectors) says of the ints x and y, a number or a vec4, rounded to 32 bits.
 *   CASE_TEXTURE_MIPPED(name, width, height, expression)
 *       The same with every level down to 1x1, and trilinear. The expression may use the int level; x and y
 *       count that level's texels.
 *   CASE_NUMBERS(name, width, height, expression)
 *       A usampler2D for the cases below it; the expression is a uvec4.
 *   CASE_GLSL(function)
 *       A function for the cases below it, where a case needs more than one call. It gets no row of its own.
 *
 * A CASE says how stable the arithmetic is, not whether it is right: that CASE_EQUALS, the pictures and their
 * truth say. An input like 0.1 is rounded in float, not in double, and the bound has to count that; 0.125 is
 * the same in both. A name may not hold a comma. */
#include "glsl.hpp" /* first, for it is precompiled */

/* Once as definitions ... */
#define CASE(...)
#define CASE_FLIP(...)
#define CASE_EQUALS(...)
#define CASE_TEXTURE_OF(type, sampler, width, height, mipped, whole, make, ...)                              \
    static CaseTexture texture_##sampler = {width,                                                           \
                                            height,                                                          \
                                            mipped,                                                          \
                                            whole,                                                           \
                                            [](int x, int y, int level, Texel *rgba) {                       \
                                                (void)x, (void)y, (void)level;                               \
                                                make(__VA_ARGS__, rgba);                                     \
                                            },                                                               \
                                            0,                                                               \
                                            {}};                                                             \
    static const type sampler = {&texture_##sampler};
#define CASE_TEXTURE(sampler, width, height, ...)                                                            \
    CASE_TEXTURE_OF(sampler2D, sampler, width, height, false, false, case_texel, __VA_ARGS__)
#define CASE_TEXTURE_MIPPED(sampler, width, height, ...)                                                     \
    CASE_TEXTURE_OF(sampler2D, sampler, width, height, true, false, case_texel, __VA_ARGS__)
#define CASE_NUMBERS(sampler, width, height, ...)                                                            \
    CASE_TEXTURE_OF(usampler2D, sampler, width, height, false, true, case_numbers, __VA_ARGS__)
#define CASE_GLSL(...) __VA_ARGS__

namespace CASES_NAMESPACE {
#include "techniques.h" /* made by cases.mk: an #import of each technique file */
#include "cases.h"
} // namespace CASES_NAMESPACE

/* ... and once as the table. */
#undef CASE
#undef CASE_FLIP
#undef CASE_EQUALS
#undef CASE_TEXTURE
#undef CASE_TEXTURE_MIPPED
#undef CASE_NUMBERS
#undef CASE_GLSL
#define CASE_OF(name, bound, unit, flip, text, ...)                                                          \
    {name, nullptr, text, unit, bound, flip, [] { return case_value(__VA_ARGS__); }},
#define CASE(name, bound, unit, ...) CASE_OF(name, bound, unit, false, #__VA_ARGS__, __VA_ARGS__)
#define CASE_FLIP(name, jump, unit, ...) CASE_OF(name, jump, unit, true, #__VA_ARGS__, __VA_ARGS__)
#ifdef CASES_DOUBLE
#define CASE_EQUALS(name, bound, unit, expected, ...)                                                        \
    CASE_OF(name, bound, unit, false, #__VA_ARGS__, expected)
#else
#define CASE_EQUALS(name, bound, unit, expected, ...) CASE(name, bound, unit, __VA_ARGS__)
#endif
#define CASE_TEXTURE(sampler, ...) {#sampler, &texture_##sampler, "", "", 0, false, nullptr},
#define CASE_TEXTURE_MIPPED CASE_TEXTURE
#define CASE_NUMBERS CASE_TEXTURE
#define CASE_GLSL(...) {"", nullptr, #__VA_ARGS__, "", 0, false, nullptr},

namespace CASES_NAMESPACE {

static const Case *cases(int *count) {
    static const Case table[] = {
#include "cases.h"
        {} /* so that it is never empty */
    };
    *count = int(sizeof table / sizeof *table) - 1;
    return table;
}

} // namespace CASES_NAMESPACE

#ifdef CASES_DOUBLE
const Case *cases_in_double(int *count) { return in_double::cases(count); }
const char *cases_folder(void) { return CASES_FOLDER; }
#else
const Case *cases_in_float(int *count) { return in_float::cases(count); }
#endif
