% The natural frequencies of a body, and a receptance of it, in MATLAB or Octave.
%
%   chladni run ../response/scene.toml --output out
%   chladni export out/tap.body.h5 --format mat --output tap.mat
%   octave receptance.m          % or `receptance` in MATLAB, in the folder of tap.mat
%
% It prints the frequencies and writes receptance.csv: Hz, and the real and imaginary part of the
% displacement in m of the output node for each N at the load node.

load tap.mat
omega = body.frequencies(:);  % rad/s
fprintf('mode %d: %.3f Hz\n', [1:numel(omega); omega' / (2 * pi)]);

z = 3;                        % components: x y z rx ry rz
load_node = 1;                % places in body.node_numbers, here the first node of the track
output_node = 1;
row = @(node) body.row_nodes(:) == node & body.row_components(:) == z;
phi_load = body.attachment_displacements(row(load_node), :);
phi_output = body.attachment_displacements(row(output_node), :);

% (diag(omega^2) (1 + i eta) + i Omega C - Omega^2 I) q = phi_load' * 1 N, u = phi_output q
eta = 0.002;
n = numel(omega);
C = zeros(n);
if ~isempty(body.damping), C = body.damping; end
f_Hz = linspace(100, 5000, 981)';
u = zeros(size(f_Hz));
for k = 1:numel(f_Hz)
  Omega = 2 * pi * f_Hz(k);
  q = (diag(omega.^2 * (1 + 1i * eta)) + 1i * Omega * C - Omega^2 * eye(n)) \ phi_load';
  u(k) = phi_output * q;
end

file = fopen('receptance.csv', 'w');
fprintf(file, '%.17g,%.17g,%.17g\n', [f_Hz, real(u), imag(u)]');
fclose(file);
