#!/usr/bin/perl
# The images: generate draws the same bytes every time, fetch lets no wrong byte through, stereo and terrain refuse
# a file that they cannot trust, and relief textures say what they measure. Needs no network: apt-get is a
# stand-in here.
use strict;
use warnings;
use File::Copy 'copy';
use File::Path 'make_path';
use File::Temp 'tempdir';
use Digest::SHA 'sha256_hex';
use Test::More;
use lib 'tests';
use Programs;

my $tmp = tempdir(CLEANUP => 1);

# Failing as a program of ours must: the status, and one line that begins and goes on as it should.
sub refuses {
    my ($what, $status, $program, $line, @command) = @_;
    my ($got, undef, $err) = run(@command);
    is $got, $status, "$what: status $status";
    like $err, qr/^$program: [^\n]*$line[^\n]*\n\z/, "$what: one line that says so";
}

# Two files of the same bytes.
sub same {
    my ($one, $other) = map { slurp($_) } @_[0, 1];
    ok defined $one && defined $other && $one eq $other, $_[2];
}

# A second run of a program that writes into a folder: the same bytes as in build/assets.
sub same_bytes {
    my ($dir, @names) = @_;
    same("$dir/$_", "build/assets/$_", "$_: the same bytes as in build/assets") for @names;
}

# ---- generate ----

my @drawn = map { "$_.png" } qw(checker zone-plate uv-grid soft-height pins-height brick-colour brick-height brick-normal
    brick-256-colour brick-256-height brick-256-normal);
make_path("$tmp/first");
is((run('build/generate', "$tmp/first"))[0], 0, 'generate runs');
opendir my $folder, "$tmp/first" or die;
is_deeply [sort grep { !/^\.\.?$/ } readdir $folder], [sort @drawn], 'it draws these and leaves nothing else';
same_bytes("$tmp/first", @drawn);
refuses('a folder that is not there', 1, 'generate', "$tmp/none/checker.png: ", 'build/generate', "$tmp/none");

# ---- fetch ----

# A package with two files, an apt-get that hands it out and counts, and a manifest.
my ($tree, $bin, $dir) = ("$tmp/tree", "$tmp/bin", "$tmp/images");
make_path("$tree/DEBIAN", "$tree/usr/share/pictures", $bin);
spew("$tree/DEBIAN/control",
    "Package: pictures\nVersion: 1\nArchitecture: all\nMaintainer: A Test <test\@example.org>\nDescription: pictures\n");
my %content = ('one.png' => "the first\n" x 100, 'two.png' => "the second\n" x 100);
spew("$tree/usr/share/pictures/$_", $content{$_}) for keys %content;
system("dpkg-deb -b '$tree' '$tmp/pictures_1_all.deb' >'$tmp/log' 2>&1") == 0 or die 'dpkg-deb -b failed';
spew("$bin/apt-get", <<"END");
#!/bin/sh
echo call >>'$tmp/calls'
case "\$*" in
*download\\ pictures) cp '$tmp/pictures_1_all.deb' . ;;
*) echo 'E: no such package' ; exit 100 ;;
esac
END
chmod 0755, "$bin/apt-get";
$ENV{PATH} = "$bin:$ENV{PATH}";

# A manifest of the two files and of one for later; the columns given replace those of two.png.
sub manifest {
    my %two = (package => 'pictures', path => 'usr/share/*/two.png', bytes => length $content{'two.png'},
        sha256 => sha256_hex($content{'two.png'}), @_);
    my $one = join ',', 'one.png', 'pictures', 'usr/share/pictures/one.png', length $content{'one.png'},
        sha256_hex($content{'one.png'});
    spew("$tmp/manifest.csv", "file,package,path-in-package,bytes,sha256,licence,used by\n$one,CC0,05\n"
        . join(',', 'two.png', @two{qw(package path bytes sha256)}) . ",CC0,14\n"
        . "three.png,nowhere,usr/three.png,1,0,CC0,later: 11\n");
}

sub calls { my $calls = slurp("$tmp/calls") // ''; return scalar(() = $calls =~ /call/g) }

sub names { opendir my $d, $dir or return ''; return join ' ', sort grep { !/^\.\.?$/ } readdir $d }

my @fetch = ('assets/fetch', $dir, "$tmp/manifest.csv");
manifest();
is((run(@fetch))[0], 0, 'fetch runs');
is names(), 'one.png two.png', 'both files are there, the later one is not, and nothing else is left';
is slurp("$dir/$_"), $content{$_}, "$_ is what the package holds" for sort keys %content;
my $before = calls();
is((run(@fetch))[0], 0, 'fetch runs again');
is calls(), $before, 'and downloads nothing';

(my $wrong = $content{'two.png'}) =~ s/second/sekond/;
spew("$dir/two.png", $wrong);
refuses('a corrupted file', 1, 'fetch', "$dir/two.png: .*sha256", @fetch);
spew("$dir/two.png", substr $content{'two.png'}, 1);
refuses('a truncated file', 1, 'fetch', "$dir/two.png: 1099 bytes .* 1100", @fetch);
is calls(), $before, 'and neither is papered over by a download';
unlink "$dir/two.png";

for my $doctored (
    ['another checksum', 'two.png .*sha256', sha256 => sha256_hex('')],
    ['another size', 'two.png .*1100 bytes .* 7', bytes => 7],
    ['a path that is not there', 'two.png: not in the package pictures', path => 'usr/share/no.png'],
    ['no such package', 'nothing: cannot be downloaded', package => 'nothing'],
) {
    my ($what, $line, @columns) = @$doctored;
    manifest(@columns);
    refuses("a manifest with $what", 1, 'fetch', $line, @fetch);
    is names(), 'one.png', "$what: no part of a file is left";
}
spew($fetch[1] = "$tmp/file", '');
refuses('a folder that is a file', 1, 'fetch', "$tmp/file: cannot be", @fetch);

$before = calls();
is((run('assets/fetch', 'build/assets'))[0], 0, 'build/assets is what the real manifest says');
is calls(), $before, 'without a download';

# ---- stereo ----

# A .npy file of 256 x 256 float32; its header's fields may be replaced.
sub npy {
    my ($values, %field) = @_;
    my $header = sprintf "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }", $field{descr} // '<f4',
        $field{order} // 'False', $field{shape} // '(256, 256)';
    $header .= ' ' x (117 - length $header) . "\n";
    return "\x93NUMPY\x01\x00" . pack('v', length $header) . $header . $values;
}

my @stereo = qw(stereo-colour.png stereo-height.exr stereo-mask.png stereo-relief.exr);
my $scene = "$tmp/scene";
make_path($scene);
copy("build/assets/$_", "$scene/$_") or die "$_: $!" for qw(motorcycle_left.png motorcycle_disp.npy);
is((run('build/stereo', $scene))[0], 0, 'stereo runs');
same_bytes($scene, @stereo);
copy('build/assets/checker.png', "$scene/motorcycle_left.png") or die "checker.png: $!";
# The left half far, the right half near, one pixel unknown: so is one texel, of 128 x 128.
my @row = ((10) x 128, (40) x 128);
my @disparity = (@row) x 256;
$disparity[256 * 101 + 51] = 9**9**9;
my $good = pack 'f<*', @disparity;
spew("$scene/motorcycle_disp.npy", npy($good));
my ($status, $out) = run('build/stereo', $scene);
is $status, 0, 'stereo runs on a scene of two depths';
like $out, qr/128 x 128 texels, 0\.01 % of them unknown/, 'one unknown pixel makes one unknown texel';
like $out, qr/depth 2701 to 4674 mm/, 'z = baseline f / (disparity + shift)';
ok -s "$scene/$_", "$_ is written" for @stereo;
unlink glob "$scene/stereo-*";

my @bad = (
    ['an empty file', '', 'not a .npy'],
    ['a header cut short', substr(npy($good), 0, 60), 'truncated in its header'],
    ['numbers cut short', substr(npy($good), 0, -1), '262143 bytes .* 262144'],
    ['doubles', npy($good, descr => '<f8'), 'float32'],
    ['columns first', npy($good, order => 'True'), 'row by row'],
    ['a shape of NaN', npy($good, shape => '(nan, 256)'), 'shape'],
    ['an enormous shape', npy($good, shape => '(99999, 99999)'), '16384'],
    ['a NaN', npy(pack('f<*', 9**9**9 / 9**9**9) . substr $good, 4), 'column 0, row 0'],
    ['every disparity unknown', npy(pack('f<', 9**9**9) x 65536), 'unknown'],
    ['a photo of another size', npy(substr($good, 4 * 256), shape => '(255, 256)'), '256 x 256 pixels'],
);
for my $case (@bad) {
    my ($what, $bytes, $line) = @$case;
    spew("$scene/motorcycle_disp.npy", $bytes);
    refuses($what, 1, 'stereo', "$scene/motorcycle_\\w+\\.\\w+: .*$line", 'build/stereo', $scene);
}
is_deeply [glob "$scene/stereo-*"], [], 'and none of them left a picture';

# ---- terrain ----

# A topography of 400 x 400 pixels as a PPM (which is known by its content, whatever its name): heights in metres by
# column and row from the top; elsewhere it is 1000 m high.
sub topography {
    my ($path, $side, %metres) = @_;
    my $plain = pack 'C3', map { $_ & 255 } 1000 * 11983 >> 16, 1000 * 11983 >> 8, 1000 * 11983;
    my $pixels = $plain x $side ** 2;
    for my $place (keys %metres) {
        my ($x, $y) = split ' ', $place;
        my $packed = $metres{$place} * 11983;
        substr $pixels, 3 * ($x + $side * $y), 3, pack 'C3', map { $_ & 255 } $packed >> 16, $packed >> 8, $packed;
    }
    spew($path, "P6\n$side $side\n255\n$pixels");
}

my $mountain = "$tmp/mountain";
make_path($mountain);
copy('build/assets/topography.png', "$mountain/topography.png") or die "topography.png: $!";
is((run('build/terrain', $mountain))[0], 0, 'terrain runs');
same_bytes($mountain, 'terrain-relief.png');

# The crop is columns 40..295 and rows 60..315. Its lowest and highest points lie in its corners; what is lower and
# higher lies just outside of them.
topography("$mountain/topography.png", 400, '40 315' => 500, '295 60' => 1200, '39 315' => 100, '40 316' => 101,
    '296 60' => 1300, '295 59' => 1301);
is((run('build/terrain', $mountain))[0], 0, 'terrain runs on a plain');
like shown("$mountain/terrain-relief.png"), qr/^origin   800 1680 1200 m\n.*^depth    700 m /ms, 'heights are metres';
unlink "$mountain/terrain-relief.png";
topography("$mountain/topography.png", 400);
refuses('a plain and nothing on it', 1, 'terrain', "$mountain/topography.png: .*same", 'build/terrain', $mountain);
topography("$mountain/topography.png", 300);
refuses('a small topography', 1, 'terrain', "$mountain/topography.png: .*smaller", 'build/terrain', $mountain);
ok !-e "$mountain/terrain-relief.png", 'and none of them left a picture';

# ---- object ----

my @faces = qw(left right bottom top back front);
my @objects = map { my $object = $_; map { "$object-$_.png" } @faces } qw(solids bunny);
my $objects = "$tmp/objects";
make_path($objects);
copy('build/assets/bunny.obj', "$objects/bunny.obj") or die "bunny.obj: $!";
is((run('build/object', $objects))[0], 0, 'object runs');
same_bytes($objects, @objects);
# Each looks out along an axis of its own, and says that what it does not see is no surface.
my $shown = shown(map { "$objects/$_" } @objects);
my $count = () = $shown =~ /^texels   256 x 256, 16 bits\nscale    .*\nbase     1\norigin   .*\na .*\nb .*\nf .*
depth    .*, shown 1 times as deep\nhollow   where h = 0$/gm;
is $count, 12, 'twelve relief textures, hollow, nothing exaggerated';
my @f = $shown =~ /^f        (.*)$/gm;
is_deeply [map { join ' ', map { $_ + 0 } split } @f], [('-1 0 0', '1 0 0', '0 -1 0', '0 1 0', '0 0 -1', '0 0 1') x 2],
    'their directions: left, right, bottom, top, back, front';

# ---- relief ----

sub shown {
    my ($status, $out) = run('build/relief', 'show', @_);
    is $status, 0, "@_: relief textures";
    return $out;
}

# An image of one pixel, whose height is 2.
sub tall {
    spew($_[0], "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" . pack 'C4', 128, 128, 128, 130);
    return $_[0];
}

sub relief_refuses {
    my ($what, $status, $line, @arguments) = @_;
    refuses($what, $status, 'relief', $line, 'build/relief', @arguments);
}

is shown(map { "build/assets/$_" } 'brick-relief.png', 'terrain-relief.png', 'stereo-relief.exr'), <<'END',
build/assets/brick-relief.png
texels   256 x 256, 16 bits
scale    0.1
base     1
origin   -360 -360 0 mm
a        720 0 0 mm
b        0 720 0 mm
f        0 0 1
depth    72 mm from h = 0 to h = 1, shown 1 times as deep
build/assets/terrain-relief.png
texels   256 x 256, 16 bits
scale    0.10197566
base     1
origin   800 1680 530.6049194 m
a        5120 0 0 m
b        0 5120 0 m
f        0 0 1.5
depth    348.0769196 m from h = 0 to h = 1, shown 1.5 times as deep
build/assets/stereo-relief.exr
texels   370 x 250, 32 bits
scale    0.1150286462
base     1
origin   -784.8445455 -530.3003686 -2110.548801 mm
a        1569.689091 0 0 mm
b        0 1060.600737 0 mm
f        0 0 0.0625
depth    2888.947377 mm from h = 0 to h = 1, shown 0.0625 times as deep
END
    'a wall 72 mm deep, a mountain 530.6 m high, a motorcycle 2889 mm deep';

my ($c, $h, $r) = map { "$tmp/$_" } qw(c.png h.png r.png);
my @wall = map { "build/assets/brick-256-$_.png" } qw(colour height);
is((run('build/relief', 'split', 'build/assets/brick-relief.png', $c, $h))[0], 0, 'relief splits');
same($h, $wall[1], 'the height is what it was made of');
is((run('build/relief', 'combine', $c, $h, $r, '--like', 'build/assets/brick-relief.png'))[0], 0, 'and combines');
same($r, 'build/assets/brick-relief.png', 'the same bytes again');
is((run('build/relief', 'combine', qw(--scale=-0.25 --base 0.5 --hollow --bits=8), @wall, $r))[0], 0, 'with options');
is shown($r), "$r\ntexels   256 x 256, 8 bits\nscale    -0.25\nbase     0.5\nhollow   where h = 0\n", 'which it keeps';
my $like = "$tmp/like.png";
is((run('build/relief', 'combine', @wall, $like, '--like', $r))[0], 0, 'like a hollow one');
is shown($like), "$like\ntexels   256 x 256, 16 bits\nscale    -0.25\nbase     0.5\nhollow   where h = 0\n", 'hollow too';
my @wide = map { "build/assets/stereo-$_" } 'colour.png', 'height.exr';
is((run('build/relief', 'combine', @wide, $like, '--width=37'))[0], 0, 'a wide one');
like shown($like), qr/^a        37 0 0\nb        0 25 0\n/m, 'is as tall as its texels say';
is((run('build/relief', 'combine', ('build/assets/checker.png') x 2, $r))[0], 0, 'from what says nothing');
is shown($r), "$r\ntexels   256 x 256, 16 bits\nscale    0.1\nbase     1\n", 'scale 0.1 and base 1';
my @clean = ('env', map({ ('-u', $_) } qw(MAKEFLAGS MAKELEVEL MFLAGS)), 'make', '-s', 'relief');
is((run(@clean, "COLOUR=$wall[0]", "HEIGHT=$wall[1]", "OUT=$r", 'WIDTH=720', 'UNIT=mm'))[0], 0, 'make relief');
same($r, 'build/assets/brick-relief.png', 'does the same');
my ($made, undef, $said) = run(@clean, "COLOUR=$wall[0]");
ok $made == 2 && $said =~ /usage: make relief COLOUR=/, 'and says what it lacks';

unlink $r;
relief_refuses('nothing to do', 2, 'usage');
relief_refuses('an unknown command', 2, 'fold', 'fold', $r);
relief_refuses('files too few', 2, 'takes 3 files, not 2', 'combine', $c, $h);
relief_refuses('files too many', 2, 'takes 3 files, not 4', 'split', $r, $c, $h, $r);
relief_refuses('nothing to show', 2, 'show', 'show');
relief_refuses("an unknown option", 2, '--deep', 'combine', $c, $h, $r, '--deep');
relief_refuses("no value", 2, '--scale', 'combine', $c, $h, $r, '--scale');
relief_refuses("--$_->[0] $_->[1]", 2, "--$_->[0]", 'combine', $c, $h, $r, "--$_->[0]=$_->[1]")
    for [scale => 'deep'], [scale => 'nan'], [base => '1,5'], [width => 0], [bits => 12], [bits => 8.5],
    [unit => 'nautical miles!!'];
relief_refuses('two sizes', 1, "$r: .*256 x 256 .*128 x 128", 'combine', $c, 'build/assets/soft-height.png', $r);
relief_refuses('heights above 1', 1, 'tall.hdr: a height must', 'combine', $c, tall("$tmp/tall.hdr"), $r);
relief_refuses('like no relief', 1, "$c: not a relief", 'combine', $c, $h, $r, '--like', $c);
relief_refuses('no relief to show', 1, "$h: not a relief", 'show', $h);
ok !-e $r, 'and none of them left a picture';

done_testing;
