! Calls uel as Abaqus does: several iterations an increment, SVARS as at its start in each of them.
! The second argument is alpha of the time integration.
program drive_uel
  implicit none
  integer :: jprops(1) = 7, lflags(5) = [1, 1, 1, 0, 0], jdltyp(1, 1), step, trial, more
  real(8) :: rhs(12, 1), amatrx(12, 12), svars(@LIR_SIZE@), start(@LIR_SIZE@), energy(8), props(1)
  real(8) :: coords(3, 2), u(12), du(12, 1), v(12), a(12), time(2), dtime, params(3), other(1, 1)
  real(8) :: predef(2, 1, 2), pnewdt, motion(25), before
  character(32) :: word
  svars = 0.0d0; energy = 0.0d0; params = 0.0d0; before = 0.0d0; step = 0
  call get_command_argument(2, word)
  if (word /= '') read (word, *) params(1)
  do
    read (*, *, iostat=more) motion
    if (more /= 0) exit
    step = step + 1
    dtime = motion(1) - before
    before = motion(1)
    if (dtime > 0.0d0) lflags(1) = 11
    start = svars
    do trial = 1, 2
      svars = start
      u = motion(2:13)
      if (trial == 1) u(7) = u(7) + 1.0d-4
      v = motion(14:25)
      pnewdt = 1.0d0
      time = motion(1)
      call uel(rhs, amatrx, svars, energy, 12, 1, @LIR_SIZE@, props, 0, coords, 3, 2, u, du, v, a, 1, &
               time, dtime, merge(2, 1, dtime > 0.0d0), step, 1, params, 0, jdltyp, other, predef, 1, &
               lflags, 12, other, 1, pnewdt, jprops, 1, 1.0d0)
    end do
    if (pnewdt /= 1.0d0) error stop 'the increment is cut'
    write (*, '(156(es25.17e3, 1x))') -rhs(:, 1), transpose(amatrx)
  end do
end program

subroutine getoutdir(folder, length)
  character(*) :: folder
  integer :: length
  folder = '.'
  length = 1
end subroutine

subroutine xit
  error stop 'xit'
end subroutine
