#!/usr/bin/perl
# What goes wrong says so: one line that names the thing, the right status, and no half-written file.
use strict;
use warnings;
use Test::More;
use File::Temp qw(tempdir);
use Compress::Zlib qw(crc32);

my $lesson = 'build/14-parallax';
my $temp   = tempdir(CLEANUP => 1);
delete @ENV{qw(DISPLAY WAYLAND_DISPLAY)};

sub run { # status and what was said on both outputs
    my ($command) = @_;
    my $said = `$command 2>&1 </dev/null`;
    return ($? >> 8, $said);
}

sub refuses { # the command ends with the status and one line that holds the pattern
    my ($status, $pattern, $arguments, $program) = @_;
    my ($got, $said) = run(($program // $lesson) . " $arguments");
    my $lines = () = $said =~ /\n/g;
    ok($got == $status && $lines == 1 && $said =~ $pattern, "$arguments: status $status, one line with $pattern")
        or diag "status $got: $said";
}

sub file { # a file with these bytes
    my ($name, $bytes) = @_;
    open my $out, '>:raw', "$temp/$name" or die;
    print $out $bytes;
    close $out;
    return "$temp/$name";
}

sub bytes {
    open my $in, '<:raw', $_[0] or die "$_[0]: $!";
    local $/;
    return <$in>;
}

# ---- The command line itself ----
refuses(2, qr/--nonsense/, '--nonsense');
refuses(2, qr/--size/, '--size');
refuses(2, qr/--size 0x0/, '--size 0x0');
refuses(2, qr/--size 99999x99999/, '--size 99999x99999');
refuses(2, qr/--size 12x/, '--size 12x');
refuses(2, qr/--size 1e3x5/, '--size 1e3x5');
refuses(2, qr/--scene nowhere/, '--scene nowhere --list');
refuses(2, qr/--technique magic/, '--technique magic --list');
refuses(2, qr/--view nowhere/, '--view nowhere --list');
refuses(2, qr/--knob many/, '--knob many --list');
refuses(2, qr/--scale nan/, '--scale nan --list');
refuses(2, qr/--scale -1/, '--scale -1 --list');
refuses(2, qr/stray/, 'stray');
refuses(1, qr/--render/, ''); # no display

my ($status, $help) = run("$lesson --help");
ok($status == 0 && $help =~ /--measure/, '--help helps');

# ---- Files ----
system("build/relief combine --base 1e300 build/assets/checker.png build/assets/checker.png $temp/far.png");
refuses(1, qr{far.png: its base is 1e\+300}, "--height $temp/far.png --render $temp/far");
my $small = '--scene brick --technique plain --view front --size 8x8';
my $png   = bytes('build/assets/brick-colour.png');
my $half  = file('truncated.png', substr $png, 0, length($png) / 2); # test_image.c has all that can be wrong
refuses(1, qr/truncated\.png/, "$small --render $temp/out --colour $half");
refuses(1, qr/truncated\.png/, "--technique nearest --size 8x8 --scene photo --render $temp/out --colour $half",
    'build/05-mipmapping');
refuses(1, qr/missing\.png/, "$small --render $temp/out --height $temp/missing.png");
refuses(1, qr/tall\.pfm/, "$small --render $temp/out --height "
    . file('tall.pfm', "Pf\n2 2\n-1.0\n" . pack('f<4', 0.5, 3, 0.5, 0.5)));
is_deeply([glob("$temp/out/* $temp/out/.[!.]*")], [], 'nothing was written by what failed');

refuses(2, qr/--nonsense/, '--nonsense', 'build/04-perspective');
refuses(2, qr/--scale 1e6/, '--scale 1e6 --list');
refuses(2, qr/nothing is chosen/, "--technique distortion-map --view 85 --render $temp/out");

# ---- A height map's own base: the polygon is at the top of brick-height.png, and at the bottom of this one ----
my $bottom = bytes('build/assets/brick-height.png');
my $chunk  = "tEXttexel:base\0";
my $at     = index $bottom, $chunk . '1';
ok($at > 0, 'brick-height.png says its base');
substr($bottom, $at + length $chunk, 1) = '0';
substr($bottom, $at + length($chunk) + 1, 4) = pack 'N', crc32(substr $bottom, $at, length($chunk) + 1);
file('bottom.png', $bottom);
my ($listed, $list) = run("$lesson --list --scene brick --height $temp/bottom.png");
like($list, qr/^  base_of_file 0$/m, '--list says the base of the file');
run("$lesson --scene brick --technique per-pixel --view 60 --size 32x24 --height $_->[0] --render $temp/$_->[1]")
    for ['build/assets/brick-height.png', 'top'], ["$temp/bottom.png", 'bottom'];
ok(bytes("$temp/top/brick-60-per-pixel.png") ne bytes("$temp/bottom/brick-60-per-pixel.png"),
    'and the polygon lies there');

# ---- Where to write ----
my $blocked = file('a-file', 'x');
refuses(1, qr/a-file/, "$small --render $blocked");
refuses(1, qr/a-file/, "$small --render $blocked/below");
refuses(1, qr{/proc/nowhere}, "$small --measure /proc/nowhere/table.csv");
refuses(1, qr/\Q$temp\E/, "$small --measure $temp");

# ---- And what goes right, from any working directory ----
my $here = `pwd`;
chomp $here;
($status, my $said) = run("cd / && $here/$lesson $small --render $temp/right --truth $temp/right");
is($status, 0, 'renders from another directory') or diag $said;
ok(-s "$temp/right/brick-front-$_", "brick-front-$_") for qw(plain.png plain.exr truth.png truth.exr);
($status, $said) = run("$lesson $small --colour build/assets/coffee.png --height build/assets/brick-256-height.png"
    . " --render $temp/own");
is($status, 0, 'draws a user\'s own images of different sizes') or diag $said;
($status, $said) = run("$lesson --list");
ok($status == 0 && $said =~ /^scene brick/m && $said =~ /fov_y_degrees/, '--list lists');

# ---- OpenGL is called through the context's own functions alone: a linked one would silently be OSMesa's ----
my @linked = grep { /\bU gl[A-Z]/ } `nm -D -u build/libtexel.so $lesson`;
is("@linked", '', 'no OpenGL function is linked by name');

done_testing();
