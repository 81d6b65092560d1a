#!/usr/bin/perl
# The images: generate draws the same bytes every time, fetch lets no wrong byte through, and stereo refuses a
# disparity file that it cannot trust. Needs no network: apt-get is a stand-in here.
use strict;
use warnings;
use File::Copy 'copy';
use File::Path 'make_path';
use File::Temp 'tempdir';
use Digest::SHA 'sha256_hex';
use Test::More;

my $tmp = tempdir(CLEANUP => 1);

sub slurp {
    my ($path) = @_;
    open my $file, '<:raw', $path or return undef;
    local $/;
    return scalar <$file>;
}

sub spew {
    my ($path, $bytes) = @_;
    open my $file, '>:raw', $path or die "$path: $!";
    print $file $bytes;
    close $file or die "$path: $!";
}

# Runs a command; returns its status, standard output and standard error.
sub run {
    my $pid = fork // die "fork: $!";
    if (!$pid) {
        open STDOUT, '>', "$tmp/out" or die;
        open STDERR, '>', "$tmp/err" or die;
        exec @_ or exit 127;
    }
    waitpid $pid, 0;
    return ($? & 127 ? "signal " . ($? & 127) : $? >> 8, slurp("$tmp/out"), slurp("$tmp/err"));
}

# Failing as a program of ours must: the status, and one line that begins and goes on as it should.
sub refuses {
    my ($what, $status, $program, $line, @command) = @_;
    my ($got, undef, $err) = run(@command);
    is $got, $status, "$what: status $status";
    like $err, qr/^$program: [^\n]*$line[^\n]*\n\z/, "$what: one line that says so";
}

# ---- generate ----

my @drawn = map { "$_.png" } qw(checker zone-plate uv-grid soft-height pins-height brick-colour brick-height brick-normal
    brick-256-colour brick-256-height brick-256-normal);
make_path("$tmp/first");
is((run('build/generate', "$tmp/first"))[0], 0, 'generate runs');
opendir my $folder, "$tmp/first" or die;
is_deeply [sort grep { !/^\.\.?$/ } readdir $folder], [sort @drawn], 'it draws these and leaves nothing else';
for my $name (@drawn) {
    my ($first, $built) = (slurp("$tmp/first/$name"), slurp("build/assets/$name"));
    ok defined $first && defined $built && $first eq $built, "$name: the same bytes as in build/assets";
}
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

my $scene = "$tmp/scene";
make_path($scene);
copy('build/assets/checker.png', "$scene/motorcycle_left.png") or die "checker.png: $!";
# The left half far, the right half near, one pixel unknown: so is one texel, of 128 x 128.
my @row = ((10) x 128, (40) x 128);
my @disparity = (@row) x 256;
$disparity[256 * 101 + 51] = 9**9**9;
my $good = pack 'f<*', @disparity;
spew("$scene/motorcycle_disp.npy", npy($good));
my ($status, $out) = run('build/stereo', $scene);
is $status, 0, 'stereo runs';
like $out, qr/128 x 128 texels, 0\.01 % of them unknown/, 'one unknown pixel makes one unknown texel';
like $out, qr/depth 2701 to 4674 mm/, 'z = baseline f / (disparity + shift)';
ok -s "$scene/$_", "$_ is written" for qw(stereo-colour.png stereo-height.exr stereo-mask.png);
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

done_testing;
