#!/usr/bin/perl
# light-field: what is stopped halfway goes on to the same bytes, what is broken is told, and what is there stays.
use strict;
use warnings;
use File::Temp 'tempdir';
use Test::More;
use lib 'tests';
use Programs;
use Time::HiRes 'sleep';

my $tmp = tempdir(CLEANUP => 1);

my @make = qw(build/light-field make);

sub makes { # a file, or fails the test
    my ($what, @rest) = @_;
    my ($status, $out, $err) = run(@make, @rest);
    is($status, 0, $what) or diag $err;
    return ($out, $err);
}

sub refuses { # the status, one line that says it, and no file of that name
    my ($what, $status, $line, @command) = @_;
    my ($got, undef, $err) = run('build/light-field', @command);
    ok($got eq $status && $err =~ /^light-field: [^\n]*$line[^\n]*\n\z/, "$what: status $status, one line that says so")
        or diag "status $got: $err";
}

sub same {
    my ($one, $other, $what) = @_;
    my ($a, $b) = (slurp($one), slurp($other));
    ok defined $a && defined $b && $a eq $b, $what;
}

# ---- What it makes ----

my $small = "$tmp/small.field";
my ($said) = makes('a small one', $small, qw(--size 16x8x9x10 --samples 3));
like $said, qr/^\Q$small\E: 34560 bytes of texels, [\d.]+ s, at most \d+ MiB of memory\n\z/, 'says what it made';
is -s $small, 128 + 8 * (24 + 16 * 9 * 10 * 3) + 24, 'a header, a section a row, and an end';
my ($status, $shown) = run(qw(build/light-field show), $small);
is $shown, <<END, 'show shows it';
$small
scene    composed
model    sphere of radius 3.5
texels   16 x 8 x 9 x 10 along u, v, s, t, linear angles
rays     3 a texel
codec    none: sRGB
sections 8 ROWS, 34560 bytes
END
my @before = stat $small;
($said) = makes('again', $small, qw(--size 16x8x9x10 --samples 3));
is $said, "$small: is there already\n", 'it is left alone';
is_deeply [(stat $small)[1, 7, 9]], [@before[1, 7, 9]], 'and was not touched';
refuses('another in its place', 1, 'small.field: is there, and is another light field',
    'make', $small, qw(--size 16x8x9x10 --samples 4));

my %shows = (
    placements => [['--scene', 'placements'], qr/^model    sphere of radius 3.5\n.*^rays     7 a texel, from outside of everything$/ms],
    around     => [['--scene', 'around'],     qr/^scene    around\n.*^model    room of radius 3.5$/ms],
    effects    => [['--scene', 'effects', '--angles', 'sine', '--radius=2.75'], qr/^model    sphere of radius 2.75\n.*sine angles$/ms],
    cylinder   => [['--model', 'cylinder', '--height', '5'], qr/^model    cylinder of radius 3.5, height 5$/m],
);
for my $name (sort keys %shows) {
    makes($name, "$tmp/$name", '--size', '16x8x8x8', @{$shows{$name}[0]});
    like((run(qw(build/light-field show), "$tmp/$name"))[1], $shows{$name}[1], "$name: and says so");
}

# ---- Stopped halfway ----

my @large = qw(--size 128x32x32x32 --samples 50);
makes('a larger one', "$tmp/whole.field", @large);
my ($stopped, $partial) = ("$tmp/stopped.field", "$tmp/stopped.field.partial");
my $pid = start(@make, $stopped, @large);
for (1 .. 10000) {
    last if -s $partial && -s $partial > 1000000;
    sleep 0.001;
}
kill 'KILL', $pid;
waitpid $pid, 0;
is $? & 127, 9, 'one is killed';
my $got = -s $partial;
ok !-e $stopped && $got > 1000000 && $got < -s "$tmp/whole.field", "halfway, and is not there yet";
ok substr(slurp("$tmp/whole.field"), 0, $got) eq slurp($partial), 'the half is the beginning of the whole';
(undef, my $err) = makes('called again', $stopped, @large);
like $err, qr/^light field composed: going on behind \d+ of 32 rows\n/, 'it goes on';
same($stopped, "$tmp/whole.field", 'to the same bytes');
ok !-e $partial, 'and nothing else is left';

# Torn anywhere, and with bytes that were never written.
my $whole = slurp($small);
my $row = 24 + 16 * 9 * 10 * 3;
for my $size (0, 1, 127, 128, 128 + $row - 1, 128 + $row, 128 + 5 * $row + 17, length($whole) - 24, length $whole) {
    spew("$tmp/torn.field.partial", substr $whole, 0, $size);
    unlink "$tmp/torn.field";
    makes("from $size bytes", "$tmp/torn.field", qw(--size 16x8x9x10 --samples 3));
    same("$tmp/torn.field", $small, "$size bytes: the same in the end");
}
my $torn = substr($whole, 0, 128 + 3 * $row) . "\0" x 3000;
spew("$tmp/zeros.field.partial", $torn);
(undef, $err) = makes('from zeros behind three rows', "$tmp/zeros.field", qw(--size 16x8x9x10 --samples 3));
like $err, qr/behind 3 of 8 rows/, 'three are kept';
same("$tmp/zeros.field", $small, 'the same in the end');
spew("$tmp/other.field.partial", $torn);
refuses('the beginning of another', 1, 'other.field.partial is the beginning of another light field',
    'make', "$tmp/other.field", qw(--size 16x8x9x10 --samples 2));
same("$tmp/other.field.partial", spew("$tmp/torn", $torn), 'is left as it was');

# ---- Broken files ----

sub shows_broken {
    my ($what, $line, $bytes) = @_;
    refuses($what, 1, "broken.field: $line", 'show', spew("$tmp/broken.field", $bytes));
}
shows_broken('nothing', 'empty', '');
shows_broken('a picture', 'not a light field', slurp('build/assets/checker.png'));
shows_broken("$_ bytes", 'truncated', substr $whole, 0, $_) for 100, 128, 150, 5000, length($whole) - 1;
shows_broken('more bytes', 'goes on for 3 bytes behind its end', "${whole}abc");
for ([20, 'its header'], [128 + 24 + 100, 'section 0'], [128 + 7 * $row + 500, 'section 7']) {
    my ($at, $part) = @$_;
    my $changed = $whole;
    substr($changed, $at, 1) ^= "\x10";
    shows_broken("byte $at changed", "broken: the checksum of $part is wrong", $changed);
}
refuses('what is not there', 1, 'none.field: No such file', 'show', "$tmp/none.field");
spew("$tmp/broken.field", substr $whole, 0, 5000);
refuses('making where a broken one is', 1, 'broken.field: truncated', 'make', "$tmp/broken.field", '--size', '16x8x8x8');

# ---- The lesson that reads it ----

my @shows = qw(build/18-light-field --scene composed --view front --size 32x24);

sub picture { # of a light field, by a technique
    my ($what, $field, $technique) = @_;
    my ($status, undef, $err) = run(@shows, '--technique', $technique, '--colour', $field, '--render', "$tmp/shown");
    is($status, 0, $what) or diag $err;
    return slurp("$tmp/shown/composed-front-$technique.exr");
}

sub not_shown {
    my ($what, $line, $field, @rest) = @_;
    my ($status, undef, $err) = run(@shows, qw(--technique paper), '--colour', $field, '--render', "$tmp/shown", @rest);
    ok($status eq 1 && $err =~ /^18-light-field: [^\n]*$line\n\z/, "$what is not shown") or diag "status $status: $err";
}

# Noise tells what was read: were the texels made again, one ray each, those of two files would be the same.
makes("$_ rays", "$tmp/$_.field", qw(--size 16x8x9x10 --samples), $_) for 1, 50;
my $shown_1 = picture('one ray a texel', "$tmp/1.field", 'paper');
ok $shown_1 ne picture('fifty', "$tmp/50.field", 'paper'), 'what is shown is what is in the file';
ok picture('in pages', "$tmp/1.field", 'paper-pages') eq $shown_1, 'paper-pages shows the same';
picture("$_ shows a file", $small, $_) for qw(depth-corrected trilinear paper-fast);
makes('one of two textures', "$tmp/wide.field", qw(--size 1024x8x32x8 --samples 1));
picture('in two textures', "$tmp/wide.field", 'paper-pages');
not_shown('it by a shader for one', 'paper: this light field lies in 2 textures, which paper-pages alone reads', "$tmp/wide.field");
not_shown('one of another scene', 'placements: is a light field of placements, not of the scene composed', "$tmp/placements");
not_shown('one with other light', 'effects: is a light field of effects, not of the scene composed', "$tmp/effects");
makes('a smaller model', "$tmp/less.field", qw(--size 16x8x9x10 --radius 2.75));
not_shown('one on a smaller model', 'less.field: is on another model than the scene composed has', "$tmp/less.field");
not_shown('one on a cylinder', 'cylinder: is on another model than the scene composed has', "$tmp/cylinder");
makes('sines', "$tmp/sine.field", qw(--size 16x8x9x10 --angles sine));
not_shown('one of other angles', 'sine.field: its angles are not linear', "$tmp/sine.field");
not_shown('a broken one', 'broken.field: truncated[^\n]*', spew("$tmp/broken.field", substr $whole, 0, 5000));
not_shown('a picture', 'checker.png: not a light field', 'build/assets/checker.png');
substr(my $changed = $whole, 128 + 3 * $row + 500, 1) ^= "\x10";
not_shown('one with a wrong byte', 'broken.field: broken: the checksum of section 3 is wrong', spew("$tmp/broken.field", $changed));

# ---- A disk that is full: here a limit on a file's size, 100 KiB ----

{
    local $SIG{XFSZ} = 'IGNORE';
    my ($got, undef, $err) = run('sh', '-c', "ulimit -f 200; exec build/light-field make $tmp/full.field --size 16x8x32x32");
    ok $got == 1 && $err =~ m{^light-field: \Q$tmp\E/full.field.partial: File too large\n\z}, 'a full disk is told' or diag $err;
    ok !-e "$tmp/full.field", 'and leaves no file';
    makes('with more room', "$tmp/full.field", qw(--size 16x8x32x32));
    makes('without the trouble', "$tmp/free.field", qw(--size 16x8x32x32));
    same("$tmp/full.field", "$tmp/free.field", 'it goes on to the same bytes');
}

# ---- The command line ----

my $none = "$tmp/none.field";
my @size = qw(--size 16x8x8x8);
refuses('nothing to do', 2, 'usage');
refuses('an unknown command', 2, 'bake: neither make nor show', 'bake', $none);
refuses('no file', 2, 'takes one file', 'make', @size);
refuses('two files', 2, 'takes one file', 'make', $none, $none, @size);
refuses('nothing to show', 2, 'show: takes files', 'show');
refuses('no size', 2, '--size is missing', 'make', $none);
refuses("--size $_", 2, "--size $_: expected UxVxSxT", 'make', $none, "--size=$_")
    for '', 16, '16x8x8', '16x8x8x8x8', '16x8x8x', '16x8x8x8k', '-16x8x8x8', ' 16x8x8x8', '16,8,8,8', '9999999999999999999x8x8x8';
refuses("--size $_->[0]", 2, "--size $_->[0]: .*$_->[1]", 'make', $none, "--size=$_->[0]")
    for ['0x8x8x8', 'fewer than 8'], ['15x8x8x8', 'odd'], ['1000000x1000000x8x8', 'more than 1024'], ['16x8x257x8', 'or 256'];
refuses("--$_->[0] $_->[1]", 2, "--$_->[0] $_->[1]", 'make', $none, @size, "--$_->[0]=$_->[1]")
    for [scene => 'nowhere'], [angles => 'acute'], [model => 'torus'], [samples => 0], [samples => 4097], [samples => -1],
    [samples => 2.5], [samples => 'many'], [radius => 'nan'], [radius => '1e7'], [height => 'inf'];
refuses('a radius of 0', 1, 'none.field: a model of radius 0', 'make', $none, @size, '--radius=0');
refuses('an unknown option', 2, '--deep: no such option', 'make', $none, @size, '--deep');
refuses('no value', 2, '--size: its value is missing', 'make', $none, '--size');
refuses('no folder', 1, 'none/a.field: No such file', 'make', "$tmp/none/a.field", @size);
refuses('a folder', 1, ': Is a directory', 'make', $tmp, @size);
refuses('a device', 1, '/dev/full: not a regular file', 'make', '/dev/full', @size);
is_deeply [glob("$none*")], [], 'and none of them left a file';
my ($helped, $help) = run(qw(build/light-field --help));
ok $helped == 0 && $help =~ /--samples/, '--help helps';

my @clean = ('env', map({ ('-u', $_) } qw(MAKEFLAGS MAKELEVEL MFLAGS)), 'make', '-s', 'light-field');
is((run(@clean, 'SIZE=16x8x9x10', 'SAMPLES=3', "OUT=$none"))[0], 0, 'make light-field');
same($none, $small, 'makes the same');
my ($made, undef, $complaint) = run(@clean);
ok $made == 2 && $complaint =~ /usage: make light-field SIZE=/, 'and says what it lacks';

done_testing;
