#include "window.h"

#include "fail.h"

void window_run(const Lesson *lesson, const Options *options, const Choice *choice) {
    (void)options, (void)choice;
    fail("%s: no window yet; use --render DIR", lesson->name);
}
