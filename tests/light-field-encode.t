#!/usr/bin/perl
# 19-encode: what is stopped halfway goes on to the same bytes, what is broken is told, and what is decoded is near.
use strict;
use warnings;
use File::Temp 'tempdir';
use Test::More;
use lib 'tests';
use Programs;
use Time::HiRes 'sleep';

my $tmp = tempdir(CLEANUP => 1);

my @make = qw(build/19-encode make);

sub makes { # a file, or fails the test
    my ($what, @rest) = @_;
    my ($status, $out, $err) = run(@make, @rest);
    is($status, 0, $what) or diag $err;
    return ($out, $err);
}

sub refuses { # the status, and one line that says it
    my ($what, $status, $line, @command) = @_;
    my ($got, undef, $err) = run('build/19-encode', @command);
    ok($got eq $status && $err =~ /^19-encode: [^\n]*$line[^\n]*\n\z/, "$what: status $status, one line that says so")
        or diag "status $got: $err";
}

sub same {
    my ($one, $other, $what) = @_;
    my ($a, $b) = (slurp($one), slurp($other));
    ok defined $a && defined $b && $a eq $b, $what;
}

# ---- What it makes ----

my @small = qw(--size 34x18x9x11 --samples 2);
for (['bc1'], ['bc7'], ['vq', 9], ['ramp', 4]) {
    my ($technique, $knob) = @$_;
    my $file = "$tmp/$technique.field";
    my @rest = (@small, '--technique', $technique, $knob ? ('--knob', $knob) : (), '--verify');
    my ($said) = makes($technique, $file, @rest);
    my %said = $said =~ /^(\w+) ([\d.]+)/mg;
    is -s $file, $said{bytes}, "$technique: as many bytes as it says";
    ok $said{peak_memory_mib} > 1 && $said{peak_memory_mib} < 200, "$technique: with $said{peak_memory_mib} MiB";
    my ($status, $shown) = run(qw(build/19-encode show), $file);
    like $shown, qr/^scene composed, 2 rays a texel\n34 x 18 x 9 x 11 texels.*\n$technique \d+\n$said{bytes} bytes/m, "$technique: show";
    ($status, my $checked) = run(qw(build/19-encode check), $file);
    my %checked = $checked =~ /^(\w+) ([\d.]+)/mg;
    is $checked{texture_psnr_db}, $said{texture_psnr_db}, "$technique: checked against the scene, $checked{texture_psnr_db} dB";
    ok $checked{texture_psnr_db} > 20 && $checked{texture_psnr_all_db} > $checked{texture_psnr_db}, "$technique: is near";
    ($said) = makes("$technique again", $file, @rest);
    is $said, "$file: is there already\n", "$technique: is left alone";
}
refuses('another in its place', 1, 'ramp.field: is there, and is another light field',
    'make', "$tmp/ramp.field", @small, '--knob', 5);

# Of a raw file the same as of the scene itself.
is system("build/light-field make $tmp/raw.field --size 34x18x9x11 --samples 2 >$tmp/out"), 0, 'a raw one';
makes('from that', "$tmp/from.field", '--from', "$tmp/raw.field", '--knob', 4);
same("$tmp/from.field", "$tmp/ramp.field", 'gives the same bytes');
refuses('from what is encoded', 1, 'ramp.field: is encoded already', 'make', "$tmp/none", '--from', "$tmp/ramp.field");
refuses('show of a raw one', 1, 'raw.field: is not encoded', 'show', "$tmp/raw.field");

# ---- Stopped halfway ----

my @large = qw(--size 128x64x16x16 --knob 4);
makes('a larger one', "$tmp/whole.field", @large);
my ($stopped, $partial) = ("$tmp/stopped.field", "$tmp/stopped.field.partial");
my $pid = start(@make, $stopped, @large);
for (1 .. 10000) {
    last if -s $partial && -s $partial > 100000;
    sleep 0.001;
}
kill 'KILL', $pid;
waitpid $pid, 0;
is $? & 127, 9, 'one is killed';
my $got = -s $partial;
ok !-e $stopped && $got > 100000 && $got < -s "$tmp/whole.field", 'halfway, and is not there yet';
(undef, my $err) = makes('called again', $stopped, @large);
like $err, qr/went on behind \d+ of 8 bands\n/, 'it goes on';
same($stopped, "$tmp/whole.field", 'to the same bytes');
ok !-e $partial, 'and nothing else is left';

my ($said) = makes('a slice', "$tmp/slice.field", @large, '--bands', 3, '--verify');
like $said, qr/^bands 3 of 8\n(.*\n)*texture_psnr_db \d/, 'says so, and is verified';
ok !-e "$tmp/slice.field" && -e "$tmp/slice.field.partial", 'and is not finished';
makes('the rest', "$tmp/slice.field", @large);
same("$tmp/slice.field", "$tmp/whole.field", 'makes it the same');

# ---- Broken files ----

my $whole = slurp("$tmp/ramp.field");
sub broken {
    my ($what, $line, $bytes) = @_;
    refuses($what, 1, "broken.field: $line", 'check', spew("$tmp/broken.field", $bytes));
}
broken('nothing', 'empty', '');
broken("$_ bytes", 'truncated', substr $whole, 0, $_) for 100, 150, 5000, length($whole) - 1;
for my $at (20, 300, length($whole) - 200) {
    my $changed = $whole;
    substr($changed, $at, 1) ^= "\x10";
    broken("byte $at changed", 'broken: the checksum of', $changed);
}
refuses('what is not there', 1, 'none.field: No such file', 'check', "$tmp/none.field");

# ---- The command line ----

refuses(@$_) for
    ['no command',        2, 'usage'],
    ['another command',   2, 'neither make', 'bake'],
    ['no file',           2, 'takes one file', 'make', '--size', '8x8x8x8'],
    ['no size',           2, '--size is missing', 'make', "$tmp/x"],
    ['a size of three',   2, 'expected UxVxSxT', 'make', "$tmp/x", '--size', '8x8x8'],
    ['an absurd size',    2, 'more than 1024', 'make', "$tmp/x", '--size', '100000x8x8x8'],
    ['no such technique', 2, 'no such', 'make', "$tmp/x", '--size', '8x8x8x8', '--technique', 'zip'],
    ['no such scene',     2, 'no such', 'make', "$tmp/x", '--size', '8x8x8x8', '--scene', 'none'],
    ['a knob too far',    2, 'from 1 to 16', 'make', "$tmp/x", '--size', '8x8x8x8', '--technique', 'vq', '--knob', 17],
    ['a knob that is none', 2, 'whole number', 'make', "$tmp/x", '--size', '8x8x8x8', '--knob', '4x'],
    ['a missing value',   2, 'value is missing', 'make', "$tmp/x", '--size'],
    ['no such option',    2, 'no such option', 'make', "$tmp/x", '--fast'];
like((run(qw(build/19-encode --help)))[1], qr/--technique/, '--help');
done_testing();
